"""Bodies that can exist, drawn towards those of the model, whatever size the model takes links for."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.identified.consistent import FAR, predicts_better, rounded, towards_found_size
from lagnet.rigid_body.inertia import BODY, is_physically_consistent
from lagnet.rigid_body.random_arm import random_arm

ARM = random_arm(3, seed=12, kinds=("revolute",), fixed=False)


def cost(seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """G = YᵀY and m = Yᵀτ of the true bodies."""
    q, v, a = np.random.default_rng(seed).normal(size=(3, 60, 3))
    columns = ARM.joint_torque_regressor(q, v, a).reshape(-1, 3 * BODY)
    return columns.T @ columns, columns.T @ (columns @ ARM.inertial_parameters().ravel())


@pytest.mark.parametrize("size", [1e-3, 0.02, 50.0, 1e3])
def test_links_of_quite_another_size_are_drawn_towards_links_of_the_found_size(size: float) -> None:
    prior = rounded(size * ARM.inertial_parameters())
    found = towards_found_size(*cost(), prior)
    np.testing.assert_allclose(found, towards_found_size(*cost(), 1e-6 * prior), rtol=1e-9)
    assert 0.5 < found[:, 0].sum() / ARM.inertial_parameters()[:, 0].sum() < 2.0
    assert np.all(is_physically_consistent(found))


@pytest.mark.parametrize("size", [1.5 / FAR, 1.0, 0.6 * FAR])
def test_links_of_about_the_found_size_stay_what_the_model_says(size: float) -> None:
    prior = rounded(size * ARM.inertial_parameters())
    assert towards_found_size(*cost(), prior) is prior


@pytest.mark.parametrize("heavier", [1.0, 40.0])
def test_links_without_mass_are_drawn_towards_balls_of_about_the_found_size(heavier: float) -> None:
    gram, moment = cost()
    balls = towards_found_size(gram, heavier * moment, rounded(np.zeros((3, BODY))))
    assert np.all(is_physically_consistent(balls))
    assert np.ptp(balls[:, 0]) == 0.0
    x = balls.ravel()
    assert 1.0 / FAR <= float(heavier * moment @ x) / float(x @ gram @ x) <= FAR


def test_torque_that_no_such_links_have_leaves_the_model_as_it_is() -> None:
    gram, moment = cost()
    prior = rounded(ARM.inertial_parameters())
    assert towards_found_size(gram, -moment, prior) is prior


def test_motion_that_says_nothing_of_the_links_together_leaves_the_model_as_it_is() -> None:
    _, moment = cost()
    prior = rounded(ARM.inertial_parameters())
    unit = prior.ravel() / np.linalg.norm(prior)
    assert towards_found_size(np.eye(unit.size) - np.outer(unit, unit), moment, prior) is prior


def blocks(*per_joint: list[float]) -> np.ndarray:
    """Squared errors of each joint on six held-out blocks, shape (6, dof)."""
    return np.array(per_joint).T


LEAST = [1.0, 1.1, 0.9, 1.0, 1.05, 0.95]


def test_links_leave_the_model_where_blocks_agree_that_they_predict_better() -> None:
    before, after = blocks(LEAST, LEAST), blocks([0.7 * x for x in LEAST], [1.02 * x for x in LEAST])
    assert predicts_better(after, before)
    assert not predicts_better(before, after)


def test_one_block_that_gains_is_not_enough() -> None:
    before, after = blocks(LEAST, LEAST), blocks([0.1, *LEAST[1:]], LEAST)
    assert after.sum() < 0.95 * before.sum()
    assert not predicts_better(after, before)


def test_no_joint_is_given_up_for_a_smaller_gain_of_another() -> None:
    before, after = blocks(LEAST, LEAST), blocks([0.9 * x for x in LEAST], [1.3 * x for x in LEAST])
    assert not predicts_better(after, before)


def test_a_gain_of_a_hundredth_does_not_move_the_links() -> None:
    assert not predicts_better(blocks([0.99 * x for x in LEAST]), blocks(LEAST))
