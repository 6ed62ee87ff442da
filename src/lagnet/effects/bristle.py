"""State of friction that builds up over a distance after a reversal: dz = (sign dq − z) |dq| / distance.

Source: Canudas de Wit 1995.
"""

from __future__ import annotations

import numpy as np
from numba import njit


def bristle(q: np.ndarray, distance: float) -> np.ndarray:
    """Bend z of the bristles over that at which they slide, from zero, exact while the sign of dq stays.

    Args:
        q: shape (n,), position [rad].
        distance: over which friction builds up [rad].

    Returns:
        Shape (n,), between −1 and 1.
    """
    return _bent(np.ascontiguousarray(q, dtype=float), float(distance))


@njit(cache=True, error_model="numpy")
def _bent(q: np.ndarray, distance: float) -> np.ndarray:
    out, bend = np.zeros(q.size), 0.0
    for i in range(1, q.size):
        step = q[i] - q[i - 1]
        push = np.sign(step)
        bend = push + (bend - push) * np.exp(-abs(step) / distance)
        out[i] = bend
    return out
