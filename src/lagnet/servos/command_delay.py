"""The command that a drive works on: held between samples, and late by a time T that need not be whole samples.

A step of a simulation that lasts from t to t + h feels the mean of u over [t − T, t + h − T]. With U(t) = ∫ u dt, which
is piecewise linear for a held command, the mean is (U(t + h − T) − U(t − T)) / h: continuous in T, so that a delay can
be fitted by its derivative.
"""

from __future__ import annotations

import numpy as np
from numba import njit


def command_integral(time: np.ndarray, command: np.ndarray) -> np.ndarray:
    """U at every sample for a command that is held until the next one, shape as `command`: (n,) or (n, dof)."""
    steps = np.diff(time).reshape(-1, *([1] * (command.ndim - 1)))
    return np.concatenate([np.zeros((1, *command.shape[1:])), np.cumsum(steps * command[:-1], axis=0)])


@njit(cache=True, error_model="numpy")
def integral_at(t, first, last, k, time, command, integral):  # pragma: no cover - compiled
    """U(t) and the sample before t, searched from sample k; before the first sample the first command was held."""
    while k > first and time[k] > t:
        k -= 1
    while k < last and time[k + 1] <= t:
        k += 1
    return integral[k] + command[k] * (t - time[k]), k
