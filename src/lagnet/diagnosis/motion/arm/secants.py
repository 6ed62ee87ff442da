"""∂q̂/∂x by differences as wide as the 95 % interval of x that follows from them: slopes of motion that sticks.

A rollout that sticks and slips is a staircase in its dry friction: a joint rests where it stopped until it breaks away
a step earlier. A small difference sees either no step, as if no motion depended on the value, or one, as if all
depended on it; in both cases the interval is far too narrow. Over the width of the interval itself the slope is that
of the staircase as a whole. Where motion is smooth, both are the derivative.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.motion.arm.fitting import DIFFERENCE, Errors, sensitivities_of
from lagnet.diagnosis.motion.arm.intervals import half_widths

WIDEST = 0.5  # of the size of a value, beyond which a difference is no slope at that value
GROWTH = 4.0  # of the difference by a value that nothing shows yet
AGREE = 1.5  # factor between a half-width and its difference that is left
ROUNDS = 6
LEAST = 1e-3  # share of a value in a direction, below which it is not of it


@dataclass(frozen=True, eq=False)
class Secants:
    """Slopes of every joint's motion and the widths that follow from them.

    Args:
        slopes: ∂q̂/∂x of each joint in units of the sizes, each of shape (n, k).
        half: half-widths of 95 % intervals in the values' units, shape (k,), as far as bounds let what nothing shows.
    """

    slopes: list[np.ndarray]
    half: np.ndarray


def settled_secants(
    errors: Errors,
    values: np.ndarray,
    here: Sequence[np.ndarray],
    sizes: np.ndarray,
    floors: np.ndarray,
    nearest: Callable[[np.ndarray], np.ndarray] = np.asarray,
) -> Secants:
    """Slopes by differences that grow until no interval is wider than the difference that it came from.

    Args:
        errors: predicted less measured positions of each joint as a function of the values.
        values: where slopes are taken, shape (k,).
        here: the errors there.
        sizes: typical sizes of the values, shape (k,).
        floors: shape (joints,), resolution of the errors [rad].
        nearest: the nearest possible values; at a bound the difference is taken inwards.
    """
    slopes = sensitivities_of(errors, sizes, nearest)(values, list(here))
    steps = np.full(len(values), DIFFERENCE)
    half = _half(here, slopes, floors)
    for _ in range(ROUNDS):
        wanted = np.minimum(half, np.where(np.isfinite(half), WIDEST, GROWTH * steps))
        wanted = np.minimum(wanted, WIDEST)
        grown = np.flatnonzero(wanted > AGREE * steps)
        if not grown.size:
            break
        for k in map(int, grown):
            steps[k] = wanted[k]
            for slope, column in zip(slopes, _secant(errors, values, k, steps[k] * sizes, nearest), strict=True):
                slope[:, k] = column * sizes[k]
        half = _half(here, slopes, floors)
    return Secants(slopes, _half_within_bounds(values, here, slopes, sizes, floors, nearest) * sizes)


def _half_within_bounds(
    values: np.ndarray,
    here: Sequence[np.ndarray],
    slopes: Sequence[np.ndarray],
    sizes: np.ndarray,
    floors: np.ndarray,
    nearest: Callable[[np.ndarray], np.ndarray],
) -> np.ndarray:
    """Half-widths in units of the sizes; along what no joint shows, values may move until one of them is at a bound."""
    count = len(values)
    half, unseen = half_widths(here, slopes, floors, np.eye(count))
    low, high = (nearest(np.full(count, side)) for side in (-np.inf, np.inf))
    for u in unseen.T:
        u = np.where(np.abs(u) > LEAST, u, 0.0)
        room = np.array([np.where(u * s > 0.0, high - values, values - low) / sizes for s in (1.0, -1.0)])
        way = np.min(np.where(u != 0.0, room / np.maximum(np.abs(u), LEAST), np.inf), axis=1)
        half = half + np.where(u != 0.0, np.abs(u) * way.max(), 0.0)
    return half


def _half(here: Sequence[np.ndarray], slopes: Sequence[np.ndarray], floors: np.ndarray) -> np.ndarray:
    """Half-widths in units of the sizes, infinite in directions that no joint shows."""
    count = slopes[0].shape[1]
    half, unseen = half_widths(here, slopes, floors, np.eye(count))
    return np.where(np.sum(unseen**2, axis=1) < 0.5, half, np.inf)


def _secant(
    errors: Errors, values: np.ndarray, k: int, steps: np.ndarray, nearest: Callable[[np.ndarray], np.ndarray]
) -> list[np.ndarray]:
    """(q̂(x + s) − q̂(x − s)) over the way between of value k, of every joint."""
    step = np.zeros(len(values))
    step[k] = steps[k]
    low, high = nearest(values - step), nearest(values + step)
    return [(h - m) / (high[k] - low[k]) for m, h in zip(errors(low), errors(high), strict=True)]
