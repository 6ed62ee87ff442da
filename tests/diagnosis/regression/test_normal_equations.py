"""Coefficients that are never negative: least squares where none would be, and the bounded optimum elsewhere."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from lagnet.diagnosis.regression.normal_equations import left_beside, nonnegative_solve, ridge_solve

RIDGE = 1e-9
EXACT = 1e-6
SIGNED = np.array([True, True, True, False, False])


def equations(truth: np.ndarray, seed: int = 3, rows: int = 200):
    rng = np.random.default_rng(seed)
    table = rng.normal(size=(rows, truth.size))
    wanted = table @ truth + 0.1 * rng.normal(size=rows)
    return table, wanted, table.T @ table, table.T @ wanted


def test_what_is_positive_is_left_as_it_is() -> None:
    *_, gram, moment = equations(np.array([1.0, 2.0, 0.5, -1.0, 3.0]))
    found = nonnegative_solve(gram, moment, RIDGE, SIGNED)
    np.testing.assert_array_equal(found, ridge_solve(gram, moment, RIDGE))
    assert found[3] < 0.0


@pytest.mark.parametrize("seed", range(6))
def test_what_would_be_negative_is_zero_and_the_rest_is_fitted_without_it(seed: int) -> None:
    table, wanted, gram, moment = equations(np.array([-1.0, 2.0, 0.01, -1.0, 3.0]), seed)
    found = nonnegative_solve(gram, moment, RIDGE, SIGNED)
    best = lsq_linear(table, wanted, bounds=(np.where(SIGNED, 0.0, -np.inf), np.inf), method="bvls").x
    np.testing.assert_allclose(found, best, atol=EXACT)
    assert found[0] == 0.0


def test_each_of_a_batch_holds_its_own() -> None:
    several = [equations(truth)[2:] for truth in (np.array([1.0, -2.0, 1.0, 1.0, 1.0]), np.ones(5))]
    grams, moments = (np.array(x) for x in zip(*several, strict=True))
    for one, gram, moment in zip(nonnegative_solve(grams, moments, RIDGE, SIGNED), grams, moments, strict=True):
        np.testing.assert_allclose(one, nonnegative_solve(gram, moment, RIDGE, SIGNED), atol=EXACT)


@pytest.mark.parametrize("size", [1.0, 1e-12])
def test_what_is_left_beside_columns_is_orthogonal_to_them_whatever_their_size(size: float) -> None:
    rng = np.random.default_rng(3)
    columns, wanted = size * rng.standard_normal((50, 3)) * [1.0, 1e6, 0.0], rng.standard_normal(50)
    left = left_beside(columns, wanted)
    assert columns[:, :2].T @ left == pytest.approx(np.zeros(2), abs=1e-9 * np.linalg.norm(columns))
    assert np.sum(left**2) < np.sum(wanted**2)
    assert left_beside(columns[:, :0], wanted) == pytest.approx(wanted)
    pair = left_beside(columns, np.column_stack([wanted, 2.0 * wanted]))
    assert pair == pytest.approx(np.column_stack([left, 2.0 * left]))
