"""Normal equations say what least squares on the samples themselves would say."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.regression.bordered import BorderedSystems
from lagnet.diagnosis.regression.cross_validation import RIDGE, take_off
from lagnet.diagnosis.regression.normal_equations import ridge_solve

EXACT = 1e-6  # the ridge is 1e-7 of a column's power


@pytest.fixture
def blocks():
    rng = np.random.default_rng(5)
    tables = rng.standard_normal((6, 40, 5))
    tables[..., -1] += tables[..., 0] - 2.0 * tables[..., 2]
    return tables


def grams_of(blocks):
    return np.einsum("bni,bnj->bij", blocks, blocks)


def test_solve_is_least_squares(blocks) -> None:
    rows = blocks.reshape(-1, 5)
    gram = rows.T @ rows
    expected = np.linalg.lstsq(rows[:, :4], rows[:, 4], rcond=None)[0]
    np.testing.assert_allclose(ridge_solve(gram[:4, :4], gram[:4, 4], RIDGE), expected, atol=EXACT)


def test_loss_is_the_error_on_blocks_left_out(blocks) -> None:
    folds, columns = grams_of(blocks), np.array([0, 2])
    loss, theta = BorderedSystems(folds.sum(axis=0), folds).alone(columns)
    expected = 0.0
    for left in range(len(blocks)):
        rest = np.delete(blocks, left, axis=0).reshape(-1, 5)
        fitted = np.linalg.lstsq(rest[:, columns], rest[:, 4], rcond=None)[0]
        expected += float(np.sum((blocks[left][:, 4] - blocks[left][:, columns] @ fitted) ** 2))
    assert loss == pytest.approx(expected, rel=EXACT)
    rows = blocks.reshape(-1, 5)
    np.testing.assert_allclose(theta, np.linalg.lstsq(rows[:, columns], rows[:, 4], rcond=None)[0], atol=EXACT)


def test_loss_of_nothing_is_the_power_of_the_residual(blocks) -> None:
    folds = grams_of(blocks)
    loss, theta = BorderedSystems(folds.sum(axis=0), folds).alone(np.zeros(0, dtype=int))
    assert loss == pytest.approx(float(np.sum(blocks[..., 4] ** 2)))
    assert theta.size == 0


def test_a_contribution_taken_off_the_equations_is_one_taken_off_the_samples(blocks) -> None:
    columns, theta = np.array([1, 3]), np.array([0.7, -1.1])
    less = blocks.copy()
    less[..., 4] -= blocks[..., columns] @ theta
    np.testing.assert_allclose(take_off(grams_of(blocks), columns, theta), grams_of(less), atol=1e-9)
