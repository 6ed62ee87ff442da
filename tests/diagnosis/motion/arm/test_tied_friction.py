"""Parts of dry friction that the loads do not divide are tied, and their intervals hold what the others could be."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from lagnet.diagnosis.motion.arm.tied_friction import tie_dry_friction
from lagnet.diagnosis.motion.joint.cases import joint_case
from lagnet.diagnosis.motion.joint.fitting import Fitted
from lagnet.diagnosis.motion.joint.joint_case import JointCase, SelectionLimits
from lagnet.diagnosis.motion.joint.joint_diagnosis import JointDiagnosis
from lagnet.diagnosis.motion.joint.refitting import Selection
from lagnet.diagnosis.motion.joint.rivals import Comparison
from lagnet.diagnosis.motion.problem import MotionProblem, pose_motion_problem
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.kinematic_tree import kinematic_tree
from lagnet.rigid_body.robot import load_description
from lagnet.rollout.whole_arm import roll_out_arm
from lagnet.servos.nominal import NominalServo
from lagnet.servos.parameters import INDEX, law_vector

ENCODER = 2.0 * np.pi / 4096.0
NOMINAL = law_vector(kp=8.0, kd=0.4, viscous=0.2, coulomb=0.02, rotor=0.01)
LOAD = "load_dependent_friction"
LEVEL = 0.5 * np.pi  # [rad] where gravity's lever is longest, and hardly changes


def rolled(nominal: Any, law: np.ndarray, reach: float) -> MotionProblem:
    """A pendulum that steps and turns around the level by so many radians."""
    tree, time = kinematic_tree(load_description(nominal)), np.arange(0.0, 24.0, 0.02)
    steps = np.random.default_rng(2).uniform(-1.0, 1.0, 13)[(time / 2.0).astype(int)]
    command = LEVEL + reach * np.where(time < 12.0, steps, np.sin(0.1 * time**2))[:, None]
    q = ENCODER * np.round(roll_out_arm(tree, law[None], time, command, command[0]) / ENCODER)
    return pose_motion_problem([Recording(time, q, None, ("servo",), command=command, path="run")], tree)


def diagnosis(case: Any, named_law: np.ndarray, effects: dict[str, tuple[str, ...]], **more: Any) -> JointDiagnosis:
    """Effects with their ties, that were named with a law."""
    named = Selection(tuple(effects), Fitted(named_law, 0.0, np.zeros(0), np.zeros((0, 0)), 1e-3), np.zeros(0))
    told = tuple(Comparison(effect, 1.0, 9.0, tied, None, None) for effect, tied in effects.items())
    parts = {"law": named_law, "intervals": {}, "rejected": (), "rest": None, "nominal": NOMINAL} | more
    return JointDiagnosis(case=cast(JointCase, case), named=named, comparisons=told, **parts)


def around(law: np.ndarray, *names: str, share: float = 0.02) -> dict[str, tuple[float, float]]:
    """Intervals of law parameters, narrow ones."""
    values = {n: float(law[INDEX[n]]) for n in names}
    return {n: (v - share * v, v + share * v) for n, v in values.items()}


def tied(nominal: Any, reach: float) -> JointDiagnosis:
    law = NOMINAL.copy()
    law[[INDEX["load_driving"], INDEX["load_driven"]]] = 0.25
    problem = rolled(nominal, law, reach)
    case = joint_case(problem, 1, 0, NominalServo(NOMINAL[None], (True,), "file"), SelectionLimits())
    found = diagnosis(case, law, {LOAD: ()}, intervals=around(law, "load_driving", "load_driven"))
    return tie_dry_friction(problem, 1, NOMINAL[None], {0: found})[0]


def test_friction_per_load_is_tied_with_constant_friction_where_the_load_hardly_varies(nominal):
    found = tied(nominal, 0.03)
    assert "coulomb_friction" in found.comparisons[0].tied
    low, high = found.intervals["load_driving"]
    assert low == 0.0
    assert 0.25 < high < 0.31  # as if the nominal friction of 0.02 N m were part of it, at 0.49 N m
    assert found.intervals["load_driven"] == (low, high)


def test_friction_per_load_stays_what_it_is_where_the_load_varies(nominal):
    found = tied(nominal, 1.4)
    assert found.comparisons[0].tied == ()
    assert found.intervals["load_driving"] == pytest.approx((0.245, 0.255))


def without_motion(effects: dict[str, tuple[str, ...]], named: np.ndarray, **more: Any) -> JointDiagnosis:
    """A diagnosis whose rivals are not excited, so that no rollout is asked for."""
    case = SimpleNamespace(law=NOMINAL, base=(), excited=more.pop("excited", ()), floor=0.5 * ENCODER)
    found = diagnosis(case, named, effects, **more)
    problem: Any = SimpleNamespace(runs=())
    return tie_dry_friction(problem, 1, NOMINAL[None], {0: found})[0]


def test_a_complete_law_with_its_friction_elsewhere_widens_and_ties_a_name(monkeypatch):
    monkeypatch.setattr("lagnet.diagnosis.motion.arm.tied_friction._rivals", lambda found, effect: ())
    law = NOMINAL.copy()
    law[[INDEX["load_driving"], INDEX["load_driven"]]] = 0.8
    complete = NOMINAL.copy()
    complete[[INDEX["load_driving"], INDEX["load_driven"], INDEX["coulomb"]]] = 0.1, 0.1, 0.3
    given: dict[str, Any] = {"intervals": around(law, "load_driving", "load_driven"), "excited": ("coulomb_friction",)}
    found = without_motion({LOAD: ()}, law, **given, law=complete)
    assert found.comparisons[0].tied == ("coulomb_friction",)
    assert found.intervals["load_driving"] == pytest.approx((0.1, 0.816))
    same = without_motion({LOAD: ()}, law, **given)
    assert same.comparisons[0].tied == ()
    near = law.copy()
    near[[INDEX["load_driving"], INDEX["load_driven"], INDEX["coulomb"]]] = 0.78, 0.78, 0.3
    assert without_motion({LOAD: ()}, law, **given, law=near).comparisons[0].tied == ()


def test_a_break_away_torque_that_may_be_none_is_tied_with_the_friction_beside_it():
    law = NOMINAL.copy()
    law[[INDEX["static"], INDEX["coulomb"]]] = 0.07, 0.4
    intervals = around(law, "coulomb") | {"static": (0.0, 0.14)}
    given: dict[str, Any] = {"excited": ("coulomb_friction", "stribeck_friction")}
    found = without_motion({"static_friction": ()}, law, intervals=intervals, **given)
    assert found.comparisons[0].tied == ("coulomb_friction",)
    sure = replace(found, comparisons=(replace(found.comparisons[0], tied=()),)).intervals | {"static": (0.05, 0.09)}
    assert without_motion({"static_friction": ()}, law, intervals=sure, **given).comparisons[0].tied == ()
