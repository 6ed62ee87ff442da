"""All additions at once, against each selection solved by itself."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.regression.bordered import BorderedSystems
from lagnet.diagnosis.regression.cross_validation import RIDGE
from lagnet.diagnosis.regression.normal_equations import ridge_solve

COLUMNS, FOLDS, ROWS = 24, 6, 80
ERROR, COEFFICIENT = 1e-8, 1e-6  # relative; two ways of rounding a system whose columns are nearly the same


@pytest.fixture(scope="module")
def equations() -> tuple[np.ndarray, np.ndarray]:
    """Columns of sizes from 1e-3 to 1e3, two of them nearly the same, one that is there in one fold only, one never."""
    rng = np.random.default_rng(0)
    x = rng.normal(size=(FOLDS, ROWS, COLUMNS + 1))
    x[..., 3] = x[..., 4] + 1e-3 * x[..., 3]
    x *= 10.0 ** rng.uniform(-3.0, 3.0, COLUMNS + 1)
    x[1:, :, 7] = x[..., 8] = 0.0
    x[..., -1] = x[..., :COLUMNS] @ rng.normal(size=COLUMNS) + rng.normal(size=(FOLDS, ROWS))
    folds = np.einsum("fni,fnj->fij", x, x)
    return folds.sum(axis=0), folds


def solved_alone(total: np.ndarray, folds: np.ndarray, columns: np.ndarray) -> tuple[float, np.ndarray]:
    """Squared error on folds left out, and coefficients of all: one dense solution a fold."""
    across = np.ix_(columns, columns)
    error = 0.0
    for fold in folds:
        theta = ridge_solve((total - fold)[across], (total - fold)[columns, -1], RIDGE)
        error += fold[-1, -1] - 2.0 * theta @ fold[columns, -1] + theta @ fold[across] @ theta
    return error, ridge_solve(total[across], total[columns, -1], RIDGE)


@pytest.mark.parametrize("base", [(), (0,), (4, 9, 1), (7, 2), (5, 6, 10, 11, 12)])
@pytest.mark.parametrize("width", [1, 2, 4])
def test_additions_are_what_each_selection_gives_alone(equations, base: tuple[int, ...], width: int) -> None:
    free = [i for i in range(COLUMNS) if i not in base]
    added = np.array([free[k : k + width] for k in range(0, len(free) - width + 1, width)])
    found = BorderedSystems(*equations).with_additions(np.array(base, dtype=int), added)
    for n, own in enumerate(added):
        error, theta = solved_alone(*equations, np.array([*base, *own]))
        assert found.errors[n] == pytest.approx(error, rel=ERROR)
        np.testing.assert_allclose(found.theta[n], theta, rtol=0, atol=COEFFICIENT * np.abs(theta).max())
