"""The clock of what was logged, where a log reads it at times of its own: found in how far the joints move.

A source that writes every P seconds, read by a log at another rate, is read twice now and then or passed over, and the
stamps are those of the log. Along smooth motion each new sample is one period further, two where one was passed over:
the counts of periods give the source's own clock, on which the samples lie evenly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import convolve1d, median_filter

LEAST = 64  # samples of a stretch
AROUND = 5  # steps before and after, of which the median is the usual one; where they rest, motion starts abruptly
BESIDE = np.array([-1.0, 4.0, 0.0, 4.0, -1.0]) / 6.0  # a step from its four neighbours, exact for cubic motion
ROUNDS = 4  # in which counts of the neighbours are taken from the round before
QUARTER = 0.3186  # of a standard deviation: a quarter of all normal deviates are smaller
SURE = 6.0  # usual step over what noise alone makes of one, from which it is counted
NEAR, FAR = 0.25, 1.5  # of a period of the log: range of 99 % of the stamps around the clock, between which it is one
SMOOTHER = 0.5  # times the roughness over the stamps, at most, that positions have over the clock
SHARE = 0.99  # of the stamps
ABRUPT = 0.995  # of the samples; what is rougher than these counts as they do: a motion may start or end abruptly


@dataclass(frozen=True, eq=False)
class Clock:
    """Times at which the samples of a stretch were measured.

    Args:
        time: shape (n,), of each fresh sample [s].
        period: of the source [s].
        passed_over: samples of the source that the log lacks.
        spread: range of the stamps around these times [s].
    """

    time: np.ndarray
    period: float
    passed_over: int
    spread: float


def source_clock(time: np.ndarray, q: np.ndarray, usual_step: float) -> Clock | None:
    """The even clock on which positions were measured, if the stamps are off it and positions are far smoother over it.

    Args:
        time: shape (n,), stamps of the fresh samples [s].
        q: shape (n, dof), positions; of n samples none repeats the one before.
        usual_step: of the log [s].
    """
    if len(time) < LEAST:
        return None
    counts = _periods(q)
    index = np.concatenate([[0], np.cumsum(counts)])
    period, start = np.polyfit(index, time, 1)
    clock = start + period * index
    low, high = np.quantile(time - clock, [0.5 - SHARE / 2, 0.5 + SHARE / 2])
    if not NEAR * usual_step < high - low < FAR * usual_step:
        return None
    if not _roughness(clock, q) <= SMOOTHER * _roughness(time, q):
        return None
    return Clock(clock, float(period), int(np.sum(counts - 1)), float(high - low))


def _periods(q: np.ndarray) -> np.ndarray:
    """Periods of the source between samples, shape (n − 1,): one wherever noise hides how far the joints moved."""
    steps = np.diff(q, axis=0)
    scale = np.maximum(_noise(q), 1e-3 * np.sqrt(np.mean(steps**2, axis=0)))
    steps = steps / np.where(scale > 0, scale, np.inf)
    usual = median_filter(np.linalg.norm(steps, axis=1), AROUND, mode="nearest")
    beside = np.minimum(np.roll(usual, AROUND // 2 + 1), np.roll(usual, -(AROUND // 2 + 1)))
    counted = beside > SURE * np.sqrt(2.0 * q.shape[1])
    counts = np.ones(len(steps))
    for _ in range(ROUNDS):
        expected = convolve1d(steps / counts[:, None], BESIDE, axis=0, mode="nearest")  # of one period
        size = np.sum(expected**2, axis=1)
        periods = np.sum(steps * expected, axis=1) / np.where(size > 0, size, np.inf)
        counts = np.where(counted, np.maximum(1.0, np.rint(periods)), 1.0)
    return counts.astype(np.int64)


def _noise(q: np.ndarray) -> np.ndarray:
    """Standard deviation of white noise, shape (dof,), from small third differences: large ones hold more."""
    third = np.abs(np.diff(q, n=3, axis=0))
    return np.quantile(third, 0.25, axis=0) / (QUARTER * np.sqrt(20.0))


def _roughness(time: np.ndarray, q: np.ndarray) -> float:
    """Root mean square of how far samples are off the cubic through their four neighbours, while joints move quickly.

    In quadratic mean over joints, each in units of its step's root mean square, beyond which it moves quickly.
    """
    middle = np.arange(2, len(time) - 2)
    near = [middle + k for k in (-2, -1, 1, 2)]
    off = q[middle].copy()
    for one in near:
        others = [time[other] for other in near if other is not one]
        weight = np.prod([(time[middle] - t) / (time[one] - t) for t in others], axis=0)
        off -= weight[:, None] * q[one]
    step = np.abs(q[near[2]] - q[near[1]])
    usual = np.sqrt(np.mean(step**2, axis=0))
    quick = (step >= usual) & (usual > 0)
    if not quick.any():
        return 0.0
    relative = np.abs(off / np.where(usual > 0, usual, 1.0))[quick]
    return float(np.sqrt(np.mean(np.minimum(relative, np.quantile(relative, ABRUPT)) ** 2)))
