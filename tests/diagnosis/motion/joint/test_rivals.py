"""Of two explanations that motion does not tell apart, the one goes first with which a load could move the joint."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.motion.joint.cases import joint_case
from lagnet.diagnosis.motion.joint.fitting import robust_scale
from lagnet.diagnosis.motion.joint.joint_case import SelectionLimits
from lagnet.diagnosis.motion.joint.refitting import refit
from lagnet.diagnosis.motion.joint.rivals import compare_rivals
from lagnet.diagnosis.motion.problem import pose_motion_problem
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.kinematic_tree import kinematic_tree
from lagnet.rigid_body.robot import load_description
from lagnet.rollout.whole_arm import roll_out_arm
from lagnet.servos.nominal import NominalServo
from lagnet.servos.parameters import DRIVEN, DRIVING, law_vector

ENCODER = 2.0 * np.pi / 4096.0
SERVO = {"kp": 8.0, "kd": 0.4, "viscous": 0.2, "rotor": 0.01}
REACH = 0.15  # [rad]
LOAD = "load_dependent_friction"


def named_first(nominal, friction: float) -> tuple[str, tuple[str, ...]]:
    """What is told of a pendulum near the level, whose load of 0.49 N m hardly varies, and its ties."""
    tree, time = kinematic_tree(load_description(nominal)), np.arange(0.0, 40.0, 0.02)
    steps = np.random.default_rng(4).uniform(-1.0, 1.0, 21)[(time / 2.0).astype(int)]
    command = 0.5 * np.pi + REACH * np.where(time < 20.0, steps, np.sin(0.05 * time**2))[:, None]
    q = roll_out_arm(tree, law_vector(coulomb=friction, **SERVO)[None], time, command, command[0])
    measured = ENCODER * np.round(q / ENCODER)
    problem = pose_motion_problem([Recording(time, measured, None, ("servo",), command=command, path="run")], tree)
    given = NominalServo(law_vector(coulomb=0.02, **SERVO)[None], (True,), "file")
    case, start = joint_case(problem, 1, 0, given, SelectionLimits()), given.laws[0].copy()
    start[[DRIVING, DRIVEN]] = friction / 0.49
    selected = refit(case, (LOAD,), start, robust_scale(case.fit.errors(start), case.floor))
    _, (told,) = compare_rivals(case, selected)
    return told.effect, told.tied


def test_friction_that_would_hold_every_load_gives_way_to_its_tie(nominal):
    effect, tied = named_first(nominal, 0.55)
    assert effect == "coulomb_friction"
    assert LOAD in tied


def test_friction_that_a_load_overcomes_stays_first(nominal):
    effect, tied = named_first(nominal, 0.2)
    assert effect == LOAD
    assert "coulomb_friction" in tied
