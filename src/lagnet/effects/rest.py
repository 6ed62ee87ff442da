"""What dry friction does while a joint rests: it keeps part of the torque at which the joint came to stop."""

from __future__ import annotations

import numpy as np

SHORTEST = 0.1  # [s] below which a slow passage through zero is no rest


def held_direction(time: np.ndarray, v: np.ndarray, slow: float, direction: np.ndarray, share: float) -> np.ndarray:
    """The direction s(v) with, at rest, a share of the direction of the motion before, shape (n,).

    Before the first motion nothing is known, and s(v) stays.

    Args:
        time: shape (n,), [s].
        v: shape (n,), [rad/s].
        slow: speed below which the joint is taken to rest [rad/s].
        direction: shape (n,), s(v).
        share: 0 for friction without memory, 1 where all of it stays.
    """
    still = np.abs(v) < slow
    edges = np.flatnonzero(np.diff(np.concatenate([[0], still.astype(np.int8), [0]])))
    out = direction.copy()
    for start, stop in edges.reshape(-1, 2):
        if start > 0 and time[stop - 1] - time[start] >= SHORTEST:
            out[start:stop] = share * np.sign(v[start - 1])
    return out
