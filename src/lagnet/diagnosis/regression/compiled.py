"""Sums over small matrices, compiled: gathering their entries costs more than the arithmetic."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, error_model="numpy")
def squared_error(gram, columns, theta):
    """rᵀr − 2 θᵀm + θᵀG θ of some columns of normal equations (K + 1, K + 1) with the residual last."""
    out = gram[-1, -1]
    for i in range(len(columns)):
        row = -2.0 * gram[columns[i], -1]
        for j in range(len(columns)):
            row += gram[columns[i], columns[j]] * theta[j]
        out += theta[i] * row
    return out


@njit(cache=True, error_model="numpy")
def rows_inside(theta, base, added, lower, upper):
    """Whether coefficients (m, k + w) of columns (k,) and (m, w) lie inside the bounds of their columns, shape (m,)."""
    out = np.ones(len(theta), dtype=np.bool_)
    for n in range(len(theta)):
        for i in range(theta.shape[1]):
            column = base[i] if i < len(base) else added[n, i - len(base)]
            if not lower[column] <= theta[n, i] <= upper[column]:
                out[n] = False
    return out


@njit(cache=True, error_model="numpy")
def squared_errors(grams, columns, thetas, there):
    """Sum over blocks of `squared_error` with coefficients thetas[block, there]."""
    out = 0.0
    for b in range(len(grams)):
        out += squared_error(grams[b], columns, thetas[b][there])
    return out


@njit(cache=True, error_model="numpy")
def add_block(gram, moment, grams, here, there, weight):
    """gram[b, there, there] += weight grams[b, here, here], and moments alike, for every block b."""
    for b in range(len(grams)):
        for i in range(len(here)):
            moment[b, there[i]] += weight * grams[b, here[i], -1]
            for j in range(len(here)):
                gram[b, there[i], there[j]] += weight * grams[b, here[i], here[j]]
