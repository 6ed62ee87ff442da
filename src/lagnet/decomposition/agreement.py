"""How close two torques are: normalised mean squared error of each joint, with an interval by resampling blocks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.types import JointVector, Trajectory

RESAMPLES = 400
LEAST_BLOCKS = 8  # fewer blocks say nothing about their scatter


@dataclass(frozen=True, eq=False)
class Agreement:
    """nMSE of each joint.

    Args:
        nmse: shape (dof,), mean squared error over the variance of what is believed.
        low, high: shape (dof,), 95 % interval over blocks of the motion; nan where there are too few blocks.
    """

    nmse: JointVector
    low: JointVector
    high: JointVector


def agreement(
    estimate: Trajectory, believed: Trajectory, floor: JointVector, blocks: np.ndarray, seed: int = 0
) -> Agreement:
    """nMSE of an estimate, each joint on its own.

    Neighbouring samples err alike: whole blocks are drawn with replacement, not samples.

    Args:
        estimate, believed: shape (n, dof), torques [N m].
        floor: shape (dof,), least variance to divide by: a term that hardly varies has no error worth a ratio.
        blocks: shape (n,), number of the block that each sample is in, from 0, see `blocks_of`.
        seed: of the resampling.
    """
    n_blocks = int(blocks.max()) + 1 if blocks.size else 0
    squares = _sums((estimate - believed) ** 2, blocks, n_blocks)
    first, second = _sums(believed, blocks, n_blocks), _sums(believed**2, blocks, n_blocks)
    count = np.bincount(blocks, minlength=n_blocks).astype(float)
    centre = first.sum(axis=0) / max(count.sum(), 1.0)  # variances from centred sums, which do not cancel
    second = second - 2 * centre * first + count[:, None] * centre**2
    first = first - count[:, None] * centre
    nmse = _ratio(np.ones((1, n_blocks)), squares, first, second, count, floor)[0]
    if n_blocks < LEAST_BLOCKS:
        unknown = np.full_like(nmse, np.nan)
        return Agreement(nmse, unknown, unknown)
    rng = np.random.default_rng(seed)
    weights = rng.multinomial(n_blocks, np.full(n_blocks, 1 / n_blocks), RESAMPLES).astype(float)
    drawn = _ratio(weights, squares, first, second, count, floor)
    low, high = np.quantile(drawn, [0.025, 0.975], axis=0)
    return Agreement(nmse, np.minimum(low, nmse), np.maximum(high, nmse))


def blocks_of(time: np.ndarray, trajectory: np.ndarray, length: float = 0.5) -> np.ndarray:
    """Number of the block of each sample, shape (n,): stretches of `length` seconds that end where a trajectory ends.

    Half a second is longer than what a filter or a friction reversal smears over. At least eight blocks are made where
    there are samples enough.
    """
    if not time.size:
        return np.zeros(0, dtype=np.int64)
    edges = np.flatnonzero(np.diff(trajectory)) + 1
    starts = np.concatenate([[0], edges])
    begun = np.repeat(time[starts], np.diff(np.concatenate([starts, [time.size]])))
    total = sum(
        float(time[last] - time[first]) for first, last in zip(starts, [*(edges - 1), time.size - 1], strict=True)
    )
    length = min(length, total / LEAST_BLOCKS) if total > 0 else length
    number = np.floor((time - begun) / length + 1e-9).astype(np.int64)
    change = (np.diff(number) != 0) | (np.diff(trajectory) != 0)
    return np.concatenate([[0], np.cumsum(change)])


def variance_floor(total: Trajectory) -> JointVector:
    """Least variance that an nMSE divides by: a ten-thousandth of that of the joint's whole torque, shape (dof,)."""
    return np.maximum(1e-4 * np.var(total, axis=0), 1e-24)


def _sums(values: Trajectory, blocks: np.ndarray, n_blocks: int) -> np.ndarray:
    out = np.zeros((n_blocks, values.shape[1]))
    np.add.at(out, blocks, values)
    return out


def _ratio(
    weights: np.ndarray,
    squares: np.ndarray,
    first: np.ndarray,
    second: np.ndarray,
    count: np.ndarray,
    floor: np.ndarray,
) -> np.ndarray:
    n = (weights @ count)[:, None]
    mean = weights @ first / n
    variance = weights @ second / n - mean**2
    return weights @ squares / n / np.maximum(variance, floor)
