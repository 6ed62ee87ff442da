"""Drag with the square of speed is in a complete law where motion shows it, and not where motion is slow."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lagnet.diagnosis.motion.joint.cases import LONG, joint_case, windows_to_fit, with_long_windows
from lagnet.diagnosis.motion.joint.complete_law import complete_law
from lagnet.diagnosis.motion.joint.joint_case import SelectionLimits
from lagnet.diagnosis.motion.joint.refitting import refit
from lagnet.diagnosis.motion.problem import pose_motion_problem
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.kinematic_tree import kinematic_tree
from lagnet.rigid_body.robot import load_description
from lagnet.rollout.whole_arm import roll_out_arm
from lagnet.servos.nominal import NominalServo
from lagnet.servos.parameters import QUADRATIC, law_vector

ENCODER = 2.0 * np.pi / 4096.0
GIVEN = {"kp": 8.0, "coulomb": 0.05, "rotor": 0.01}


def complete(nominal: Path, speed: float, seconds: float, **true: float) -> np.ndarray:
    """The complete law of a servo without drag in its nominal law; it moves by its true law at about `speed`."""
    tree, time = kinematic_tree(load_description(nominal)), np.arange(0.0, seconds, 0.02)
    command = (0.5 * np.sin(2.0 * speed * time + np.sin(0.3 * time)))[:, None]
    law = law_vector(**(GIVEN | true))
    q = ENCODER * np.round(roll_out_arm(tree, law[None], time, command, np.zeros(1)) / ENCODER)
    servo = NominalServo(law_vector(**GIVEN, viscous=0.3)[None], (True,), "file")
    recording = Recording(time, q, None, ("servo",), command=command, path="run")
    problem = pose_motion_problem([recording], tree, laws=servo.laws)
    case = joint_case(problem, 1, 0, servo, SelectionLimits())
    chosen = refit(case, ("viscous_friction",), case.law, 2.0 * case.floor)
    data = replace(case.fit, windows=windows_to_fit(problem, 1, 0, LONG))
    return complete_law(with_long_windows(case, problem, 1, 0), chosen, chosen, data)


@pytest.mark.slow
def test_slow_motion_has_no_drag(nominal: Path) -> None:
    assert complete(nominal, 0.3, 40.0, viscous=0.6, static=0.05, stribeck_speed=0.1, delay=0.02)[QUADRATIC] == 0.0


@pytest.mark.slow
def test_drag_of_fast_motion_is_found(nominal: Path) -> None:
    assert complete(nominal, 3.0, 80.0, viscous=0.3, quadratic=0.4)[QUADRATIC] == pytest.approx(0.4, rel=0.1)
