"""What dry friction does while a joint rests or turns round: how its sign changes, and what it keeps at a stop."""

from __future__ import annotations

import numpy as np

SHORTEST = 0.1  # [s] below which a slow passage through zero is no rest


def blurred_sign(v: np.ndarray, slow: float, straight: bool = False) -> np.ndarray:
    """s(v): tanh(v/ε), or v/ε cut at ±1, which is what a simulator with regularised dry contact computes.

    Args:
        v: [rad/s].
        slow: ε [rad/s].
        straight: the second form.
    """
    return np.clip(v / slow, -1.0, 1.0) if straight else np.tanh(v / slow)


def held_direction(time: np.ndarray, v: np.ndarray, slow: float, direction: np.ndarray, share: float) -> np.ndarray:
    """s(v) + h s₀ (1 − |s(v)|) at rest, s₀ the direction of the motion before, shape (n,); elsewhere s(v).

    What a stop leaves of the friction gives way as the next motion begins, and does not last until it is fast. Before
    the first motion nothing is known, and s(v) stays.

    Args:
        time: shape (n,), [s].
        v: shape (n,), [rad/s].
        slow: speed below which the joint is taken to rest [rad/s].
        direction: shape (n,), s(v).
        share: h, 0 for friction without memory, 1 where all of it stays.
    """
    out = direction.copy()
    for start, stop in _rests(time, v, slow):
        if start > 0:
            out[start:stop] += share * np.sign(v[start - 1]) * (1.0 - np.abs(direction[start:stop]))
    return out


def resting(time: np.ndarray, v: np.ndarray, slow: float) -> np.ndarray:
    """Where a joint rests: stays slow for longer than a passage through zero, shape (n,), bool."""
    out = np.zeros(v.shape, dtype=bool)
    for start, stop in _rests(time, v, slow):
        out[start:stop] = True
    return out


def _rests(time: np.ndarray, v: np.ndarray, slow: float) -> list[tuple[int, int]]:
    """First sample of each rest and that after its last."""
    still = np.abs(v) < slow
    edges = np.flatnonzero(np.diff(np.concatenate([[0], still.astype(np.int8), [0]])))
    return [(a, b) for a, b in edges.reshape(-1, 2).tolist() if time[b - 1] - time[a] >= SHORTEST]
