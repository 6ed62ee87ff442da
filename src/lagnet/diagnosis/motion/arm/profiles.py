"""Ends of 95 % intervals beyond which the loss rises: what a curvature says, checked by rollouts.

A Gauss–Newton matrix says how the loss would rise if motion went on as its slopes say. At the end of a 95 % interval of
x the mean rise over blocks of time is then ½ · 1.96 of its standard errors, with the other values as they fit best
beside x. Where rollouts rise by less than half of that, the curvature is false, or the fit has stopped short: the
end goes out until they do, with the other values as they were and as slopes say that they fit best. What half a
resolution to one side makes rise is taken off first, by the same share. The block that rises most does not count: one
start that comes a step later is no evidence.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from lagnet.diagnosis.motion.arm.fitting import Errors
from lagnet.diagnosis.motion.arm.intervals import BLOCKS, NORMAL_95, ridges
from lagnet.diagnosis.motion.arm.secants import Secants
from lagnet.diagnosis.motion.joint.fitting import huber, robust_scale

SHARE = 0.5  # of the rise that slopes say, at least
RISE = 0.5 * SHARE * NORMAL_95  # standard errors over blocks
ONE_SIDED = 0.5 * SHARE  # of what half a resolution to one side makes rise
WIDER = 1.6  # by which an end goes out
MOST = 8  # times: to 43 times the half-width


def profiled_ends(
    errors: Errors,
    values: np.ndarray,
    here: Sequence[np.ndarray],
    found: Secants,
    sizes: np.ndarray,
    floors: np.ndarray,
    nearest: Callable[[np.ndarray], np.ndarray] = np.asarray,
) -> np.ndarray:
    """Low and high ends of the intervals of all values, within their bounds, shape (2, k).

    Args:
        errors: predicted less measured positions of each joint as a function of the values.
        values: the fitted ones, shape (k,).
        here: the errors there.
        found: slopes and half-widths.
        sizes: typical sizes of the values, shape (k,).
        floors: shape (joints,), resolution of the errors [rad].
        nearest: the nearest possible values.
    """
    scales = [robust_scale(e, f) for e, f in zip(here, floors, strict=True)]
    ridge, start = ridges(here, found.slopes, floors) * sizes[None, :] / sizes[:, None], _losses(here, scales)

    def rises(at: np.ndarray) -> bool:
        there = errors(at)
        moved = [np.abs(m - e) * 0.5 * f / s**2 for m, e, f, s in zip(there, here, floors, scales, strict=True)]
        return _rise(_losses(there, scales) - start - ONE_SIDED * _in_blocks(moved)) >= RISE

    ends = np.empty((2, len(values)))
    for row, side in enumerate((-1.0, 1.0)):
        for k, half in enumerate(found.half):
            ways = [way for way in (np.eye(len(values))[k], ridge[k]) if way[k] > 0.0]
            for _ in range(MOST):
                at = [nearest(values + side * half * way) for way in ways] if np.isfinite(half) else []
                if not at or not np.isclose(at[0][k], values[k] + side * half) or all(map(rises, at)):
                    break
                half *= WIDER
            ends[row, k] = values[k] + side * half
    return np.array([nearest(e) for e in ends])


def _losses(errors: Sequence[np.ndarray], scales: Sequence[float]) -> np.ndarray:
    """Huber's loss of all joints in each block of time, shape (BLOCKS,)."""
    return _in_blocks([huber(e, s) for e, s in zip(errors, scales, strict=True)])


def _in_blocks(parts: Sequence[np.ndarray]) -> np.ndarray:
    """Sums over all joints in each block of time, shape (BLOCKS,)."""
    return np.sum([[b.sum() for b in np.array_split(part, BLOCKS)] for part in parts], axis=0)


def _rise(rises: np.ndarray) -> float:
    """Mean over its standard error, over blocks, of all but the largest; infinite for a rollout that diverged."""
    if not np.isfinite(rises).all():
        return np.inf
    left = np.sort(rises)[:-1]
    return float(left.mean() / (left.std() / np.sqrt(len(left)) + 1e-300))
