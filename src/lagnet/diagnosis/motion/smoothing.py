"""Local cubics over a fixed stretch of time: position, speed and acceleration of sampled motion."""

from __future__ import annotations

import numpy as np
from scipy.signal import savgol_filter

from lagnet.recordings.sampling import median_step

SMOOTHING = 0.16  # [s] stretch over which a cubic gives speed and acceleration


def _length(time: np.ndarray) -> int:
    half = max(2, round(0.5 * SMOOTHING / median_step(time)))
    return min(2 * half + 1, len(time) - 1 + len(time) % 2)


def smoothed(time: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Positions of the local cubics, shape (n, dof)."""
    return np.asarray(savgol_filter(q, _length(time), 3, axis=0))


def motion_rates(time: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """v and a by local cubics over `SMOOTHING` seconds (Savitzky–Golay), each of shape (n, dof)."""
    length = _length(time)
    samples = np.asarray(savgol_filter(time, length, 3, deriv=1))[:, None]
    speed, acceleration = (np.asarray(savgol_filter(q, length, 3, deriv=order, axis=0)) for order in (1, 2))
    return speed / samples, acceleration / samples**2
