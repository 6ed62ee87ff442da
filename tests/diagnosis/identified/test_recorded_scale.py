"""Scales of recorded torque in the identified layer: told where joints contradict each other, and never of all."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.conftest import Plant
from tests.diagnosis.identified.test_identify import along, corrected, posed, unseen_errors, usual_load, wrong_bodies
from validation.real_arms.least_squares import LeastSquares

from lagnet.diagnosis.identified.fit import identify
from lagnet.diagnosis.identified.verdict_entry import identified_as_json
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import Robot

LESS = 0.2  # of the error of plain least squares, in the geometric mean over joints
HEAVIER = (1.3, 0.8, 1.2, 1.25)  # links of the arm over those of the model


def plant(arm: Robot, scales: np.ndarray) -> Plant:
    """Heavier links, friction, and recorded torque that is scaled at each joint; `load` is the arm's own torque."""
    size = 0.1 * usual_load(arm)
    real = wrong_bodies(arm, HEAVIER)

    def scaled(q: np.ndarray, v: np.ndarray, a: np.ndarray, load: np.ndarray) -> np.ndarray:
        return scales * (load + size * np.tanh(v / 0.02) + 0.5 * size * v) - load

    return Plant(real, [scaled])


def gains(found) -> dict[int, float]:
    pairs = zip(found.layer.terms, found.layer.weights, strict=True)
    return {t.joint: float(w) for t, w in pairs if t.kind == "gain" and w}


@pytest.mark.parametrize("seed", [5, 6, 7])
def test_a_joint_whose_torque_constant_is_wrong_is_told_against_the_others(seed: int) -> None:
    arm, scales = random_arm(4, seed=seed, kinds=("revolute",)), np.array([1.0, 0.75, 1.0, 1.0])
    problem = posed(arm, plant(arm, scales), 40.0)
    found = identify(problem, ())
    ours, theirs = (
        unseen_errors(problem, torque)
        for torque in (along(corrected(problem, found)), LeastSquares(arm, problem).torque)
    )
    assert gains(found) == {1: pytest.approx(-0.25, abs=0.01)}
    assert np.exp(np.mean(np.log(ours / theirs))) < LESS
    words = identified_as_json(found, arm, arm.joints)["words"]
    assert f"recorded torque of the bodies has another scale at {arm.joints[1]}" in words


def test_links_alone_are_no_scale() -> None:
    arm = random_arm(4, seed=5, kinds=("revolute",))
    found = identify(posed(arm, plant(arm, np.ones(4)), 40.0), ())
    assert not gains(found)


def test_a_scale_that_all_joints_share_is_that_of_the_bodies() -> None:
    arm = random_arm(4, seed=5, kinds=("revolute",))
    problem = posed(arm, plant(arm, np.full(4, 1.2)), 40.0)
    found = identify(problem, ())
    assert len(gains(found)) < arm.n_dof
    assert np.all(unseen_errors(problem, along(corrected(problem, found))) < 1e-3 * problem.unseen_variance)
