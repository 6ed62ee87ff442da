"""What a segment keeps for the effects: everything of little motion, and of much motion the torque of bodies alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.conftest import Plant

from lagnet.diagnosis.problem import problem as module
from lagnet.diagnosis.problem.problem import Problem, pose_problem
from lagnet.recordings.conditioning.condition import condition
from lagnet.rigid_body.inertia import parameters_of_body
from lagnet.rigid_body.random_arm import random_arm

BODY = parameters_of_body(2.0, np.array([0.1, 0.05, 0.02]), np.diag([0.01, 0.02, 0.015]))


@pytest.fixture
def problem() -> Problem:
    arm = random_arm(2, seed=7, kinds=("revolute",), fixed=False)
    fit = condition([Plant(arm, [], noise=1e-4).record(1)])
    return pose_problem(arm, fit, condition([Plant(arm, [], noise=1e-4).record(2)], fit.bandwidth))


def test_regressors_are_kept_of_little_motion_alone(problem: Problem, monkeypatch: pytest.MonkeyPatch) -> None:
    piece = problem.fit[0]
    assert piece.motion(problem).link_regressor(1) is piece.motion(problem).link_regressor(1)
    monkeypatch.setattr(module, "MOST_KEPT", 0.0)
    much = replace(problem)
    assert piece.motion(much).link_regressor(1) is not piece.motion(much).link_regressor(1)


def test_the_torque_of_a_body_is_kept_of_much_motion_too(problem: Problem, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MOST_KEPT", 0.0)
    piece = problem.fit[0]
    first = piece.motion(problem).body_torque(1, BODY)
    assert piece.motion(problem).body_torque(1, BODY) is first
    other = replace(problem, nominal=random_arm(2, seed=8, kinds=("revolute",), fixed=False))
    assert piece.motion(other).body_torque(1, BODY) is not first
