"""Runs of samples: where a channel keeps one value, and how long each run is."""

from __future__ import annotations

import numpy as np


def runs_of(flags: np.ndarray) -> np.ndarray:
    """Start and stop of each run of true flags, shape (k, 2)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(np.int8), [0]])))
    return edges.reshape(-1, 2)


def constant_runs(x: np.ndarray) -> np.ndarray:
    """Start and stop of each run of equal values that is longer than one sample, shape (k, 2).

    Args:
        x: shape (n,).
    """
    runs = runs_of(np.diff(x) == 0)
    return runs + np.array([0, 1])


def resolution(x: np.ndarray) -> float:
    """Smallest change that a channel shows, 0 where it never changes: on a coarse scale the step of that scale.

    Args:
        x: shape (n,).
    """
    steps = np.abs(np.diff(x))
    steps = steps[steps > 0]
    return float(np.quantile(steps, 0.01)) if steps.size else 0.0


def quantum(x: np.ndarray) -> float:
    """Smallest step between the values that a channel takes: 0 where it takes nearly as many as it has samples.

    Args:
        x: shape (n,).
    """
    values = np.unique(x)
    if values.size < 2 or values.size > 0.5 * x.size:
        return 0.0
    return float(np.quantile(np.diff(values), 0.05))
