"""The usual step of a clock, and rows spread over a table."""

from __future__ import annotations

import numpy as np

UNEVEN = 1e-6  # of a step: by so much steps of an even clock differ


def median_step(time: np.ndarray) -> float:
    """median_k (t_{k+1} − t_k) of one uninterrupted motion, shape (n,) [s]; 1 s for a single sample.

    The median leaves out gaps and jitter.
    """
    return float(np.median(np.diff(time))) if len(time) > 1 else 1.0


def spread_rows(n: int, most: int) -> np.ndarray:
    """Indices of at most so many of n rows, from the first to the last at equal distances, each once, shape (≤ most,).

    Later rows belong to other motions and poses: the first ones alone would show little of what a recording holds.
    """
    return np.unique(np.linspace(0, n - 1, min(n, most)).round().astype(int))


def is_even(time: np.ndarray) -> bool:
    """Whether all steps of an increasing clock, shape (n,) with n > 1, are the same to a millionth, by rounding."""
    step = (time[-1] - time[0]) / (len(time) - 1)
    return bool(np.max(np.abs(np.diff(time) - step)) <= UNEVEN * step)
