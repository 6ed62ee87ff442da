"""Dry friction and stops within one step: impulses that stop each row, as far as their bounds allow.

Needs NumPy alone.
"""

import numpy as np

SWEEPS = 200
SETTLED = 1e-12


def friction_impulses(delassus, free, lower, upper, guess):
    """Impulses p with lower ≤ p ≤ upper for which each row rests, or moves against the bound that p has reached.

    Projected Gauss–Seidel on w = free + delassus p.

    Args:
        delassus: shape (m, m), change of a row's speed per unit of each impulse.
        free: shape (m,), speeds of the rows at the end of the step without impulses.
        lower, upper: shape (m,), bounds of the impulses.
        guess: shape (m,), impulses of the step before.

    Returns:
        Shape (m,).
    """
    if len(free) == 1:
        return np.clip(-free / delassus[0, 0], lower, upper)
    p = np.clip(guess, lower, upper)
    for _ in range(SWEEPS):
        change = 0.0
        for i in range(len(free)):
            w = free[i] + delassus[i] @ p
            new = min(max(p[i] - w / delassus[i, i], lower[i]), upper[i])
            change = max(change, abs(new - p[i]) * delassus[i, i])
            p[i] = new
        if change < SETTLED:
            break
    return p
