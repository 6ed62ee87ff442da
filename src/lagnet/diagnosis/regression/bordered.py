"""E(S ∪ {k}) of a joint for all additions k at once, from one factorisation of the system of S.

With A = G_SS + r diag G_SS = L Lᵀ, B = L⁻¹ G_Sk and a border of its own C = G_kk + r diag G_kk, the Schur complement
C − BᵀB gives φ of the added columns and θ_S = L⁻ᵀ(L⁻¹ m_S − B φ): what a solution of the whole system gives, for the
price of a substitution with each column more. Source: Golub and Van Loan, Matrix Computations, section 4.2 (block
Cholesky). Systems are many and small, so that the loops are compiled.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from lagnet.diagnosis.regression.compiled import squared_error
from lagnet.diagnosis.regression.cross_validation import RIDGE

NOTHING = 1e-200  # power of a column without content
LEAST = 1e-14  # square of a pivot over that of its column: below it, the ridge is lost in rounding


@dataclass(frozen=True, eq=False)
class Additions:
    """Squared errors and coefficients of a selection with each of several additions.

    Args:
        errors: shape (m,), on blocks left out of the fit, summed [N² m²].
        theta: shape (m, k + w), coefficients of the columns of the selection and of the added ones, from all blocks.
    """

    errors: np.ndarray
    theta: np.ndarray


class BorderedSystems:
    """The normal equations of one joint, without each fold in turn and last with all, columns scaled to unit power."""

    def __init__(self, total: np.ndarray, folds: np.ndarray):
        """Scales them once.

        Args:
            total: shape (K + 1, K + 1), with the residual last.
            folds: shape (n_folds, K + 1, K + 1).
        """
        grams = np.concatenate([total[None] - folds, total[None]])
        power = np.diagonal(grams, axis1=1, axis2=2)
        scale = np.where(
            power > NOTHING, 1.0 / np.sqrt(np.maximum(power, NOTHING)), 0.0
        )  # no content: coefficient zero
        scale[:, -1] = 1.0
        self._scale = scale
        self._systems = grams * scale[:, :, None] * scale[:, None, :]
        self._folds = np.ascontiguousarray(folds)

    def alone(self, base: np.ndarray) -> tuple[float, np.ndarray]:
        """Squared error of a selection's columns on blocks left out of the fit, and θ of all blocks, shape (k,)."""
        found = self.with_additions(base, np.zeros((1, 0), dtype=np.int64))
        return float(found.errors[0]), found.theta[0]

    def with_additions(self, base: np.ndarray, added: np.ndarray) -> Additions:
        """Squared errors of a selection's columns with each of several additions of one width, and their coefficients.

        Args:
            base: shape (k,), columns of the selection.
            added: shape (m, w), columns of each addition.
        """
        errors, theta = _solve_all(self._systems, self._folds, self._scale, base, added, RIDGE)
        return Additions(errors, theta)


@njit(cache=True, error_model="numpy")
def _solve_all(systems, folds, scale, base, added, ridge):
    """Errors (m,) summed over the folds, and coefficients (m, k + w) of the last system."""
    m, w, k = added.shape[0], added.shape[1], base.size
    errors, theta = np.zeros(m), np.zeros((m, k + w))
    columns, coefficients = np.zeros(k + w, np.int64), np.zeros(k + w)
    _copy(base, columns, 0)
    root, half = np.zeros((k, k)), np.zeros(k)
    inner, parts = np.zeros((w, w)), np.zeros((w, k))
    for f in range(len(systems)):
        system = systems[f]
        for i in range(k):
            for j in range(i + 1):
                root[i, j] = system[base[i], base[j]]
            root[i, i] += ridge
            half[i] = system[base[i], -1]
        _factor(root)
        _forward(root, half)
        for n in range(m):
            _copy(added[n], columns, k)
            _bordered(system, root, half, columns, ridge, inner, parts, coefficients)
            for i in range(k + w):
                coefficients[i] *= scale[f, columns[i]]
            if f < len(folds):
                errors[n] += squared_error(folds[f], columns, coefficients)
            else:
                _copy(coefficients, theta[n], 0)
    return errors, theta


@njit(cache=True, error_model="numpy")
def _copy(values, out, first):
    """Writes values (n,) into out from index `first` on; an assignment to a slice takes seconds to compile."""
    for i in range(len(values)):
        out[first + i] = values[i]


@njit(cache=True, error_model="numpy")
def _bordered(system, root, half, columns, ridge, inner, parts, out):
    """Coefficients (k + w,) of a system whose first k columns have the factor L, with w columns more."""
    k, w = len(root), len(inner)
    for a in range(w):
        own = columns[k + a]
        for i in range(k):
            parts[a, i] = system[columns[i], own]
        _forward(root, parts[a])
        wanted = system[own, -1]
        for i in range(k):
            wanted -= parts[a, i] * half[i]
        out[k + a] = wanted
        for b in range(a + 1):
            inner[a, b] = system[own, columns[k + b]]
            for i in range(k):
                inner[a, b] -= parts[a, i] * parts[b, i]
        inner[a, a] += ridge
    _factor(inner)
    _forward(inner, out[k:])
    _backward(inner, out[k:])
    for i in range(k):
        out[i] = half[i]
        for a in range(w):
            out[i] -= parts[a, i] * out[k + a]
    _backward(root, out[:k])


@njit(cache=True, error_model="numpy")
def _factor(matrix):
    """L of L Lᵀ in the place of the lower triangle of a matrix of about unit diagonal."""
    for i in range(len(matrix)):
        for j in range(i + 1):
            left = matrix[i, j]
            for n in range(j):
                left -= matrix[i, n] * matrix[j, n]
            matrix[i, j] = np.sqrt(max(left, LEAST)) if i == j else left / matrix[j, j]


@njit(cache=True, error_model="numpy")
def _forward(root, x):
    """L⁻¹ x in the place of x."""
    for i in range(len(root)):
        for n in range(i):
            x[i] -= root[i, n] * x[n]
        x[i] /= root[i, i]


@njit(cache=True, error_model="numpy")
def _backward(root, x):
    """L⁻ᵀ x in the place of x."""
    for i in range(len(root) - 1, -1, -1):
        for n in range(i + 1, len(root)):
            x[i] -= root[n, i] * x[n]
        x[i] /= root[i, i]
