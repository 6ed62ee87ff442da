"""Where a link is in the gap of its transmission: on the flank that its load presses it to, or in flight between."""

from __future__ import annotations

import numpy as np
from numba import njit

from lagnet.types import Samples


def lag_in_gap(time: Samples, push: Samples, half_gap: float) -> np.ndarray:
    """Angle by which the link trails its motor inside the gap, shape (n,) [rad].

    The link rests on a flank while its load presses it there. When the load changes sign the link is left behind,
    falls freely across the gap, and stays where it lands: what bounces there are die out within the impact.

    Args:
        time: shape (n,), even clock [s].
        push: shape (n,), load of the joint over its inertia [rad/s²], linear between samples.
        half_gap: h [rad].
    """
    flanks = np.where(push >= 0.0, 1.0, -1.0)
    turns = np.flatnonzero(np.diff(flanks)) + 1
    lag, side, k = np.empty(push.size), flanks[0], 0
    while k < push.size:
        if flanks[k] == side:
            after = np.searchsorted(turns, k, side="right")
            leaves = int(turns[after]) if after < turns.size else push.size
            lag[k:leaves] = side * half_gap
            k = leaves
        else:
            k, side = _fly(time, push, half_gap, side, k, lag)
    return lag


@njit(cache=True, error_model="numpy")
def _fly(time: Samples, push: Samples, half_gap: float, side: float, first: int, lag: np.ndarray) -> tuple[int, float]:
    """Writes a flight that begins before sample `first` into `lag`: the sample after it has landed, and the flank."""
    x, w, before, left = side * half_gap, 0.0, float(push[first - 1]), float(time[first] - time[first - 1])
    if before * side > 0.0:  # it begins when there is no load
        left, before = left * float(push[first] / (push[first] - before)), 0.0
    for k in range(first, push.size):
        now = float(push[k])
        x += w * left + left**2 * (before / 3.0 + now / 6.0)
        w += left * (before + now) / 2.0
        if abs(x) > half_gap:
            since, x, w = (abs(x) - half_gap) / max(abs(w), 1e-300), float(np.copysign(half_gap, x)), 0.0
            if x * now >= 0.0:
                lag[k] = x
                return k + 1, float(np.sign(x))
            w = now * min(since, left)  # its load presses it off at once
            x = min(max(x + w * min(since, left) / 2.0, -half_gap), half_gap)
        lag[k], before = x, now
        if k + 1 < push.size:
            left = float(time[k + 1] - time[k])
    return push.size, side
