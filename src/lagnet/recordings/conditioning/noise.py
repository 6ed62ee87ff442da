"""How noisy a signal is: white noise from differences of high order, and what filters and derivatives make of it."""

from __future__ import annotations

from math import comb

import numpy as np
from scipy.ndimage import uniform_filter1d

BINS = 9  # of a spectrum that are averaged before it is held against noise
SHARE, MOST_OF_IT = 0.99, 0.95  # of the speeds' power, below whose frequency motion lies
BEYOND = 10.0  # times the frequency of most of it: so much further lies what a drive or the clock adds, and no motion
ABOVE = 20.0  # times the power of white noise from which a frequency belongs to the motion
DIFFERENCES = 6  # order: smooth motion well below the sample rate leaves no trace in it


def white_noise(x: np.ndarray, order: int = DIFFERENCES) -> np.ndarray:
    """Standard deviation of white noise (quantisation included) in smooth signals.

    The sixth difference of white noise has variance C(12, 6) σ²; of motion at frequency f it keeps (2 sin πf/f_s)¹²
    of the power.

    Args:
        x: shape (n, k), samples on an even clock.

    Returns:
        shape (k,), in the unit of x.
    """
    if x.shape[0] <= order + 1:
        return np.zeros(x.shape[1])
    return np.sqrt(np.mean(np.diff(x, n=order, axis=0) ** 2, axis=0) / comb(2 * order, order))


def band_noise(sigma: np.ndarray, rate: float, bandwidth: float, derivatives: int = 0) -> np.ndarray:
    """Standard deviation that white noise has after a low-pass and so many derivatives.

    Args:
        sigma: white noise of the samples.
        rate: sample rate [Hz].
        bandwidth: of the low-pass [Hz].
        derivatives: 0, 1 or 2.
    """
    f = min(bandwidth, 0.5 * rate)
    power = (2.0 * np.pi) ** (2 * derivatives) * f ** (2 * derivatives + 1) / (2 * derivatives + 1)
    return np.asarray(sigma) * np.sqrt(power / (0.5 * rate))


def motion_bandwidth(q: np.ndarray, rate: float) -> float:
    """Frequency [Hz] below which 99 % of the joint speeds' power lies: the median over joints that move.

    Where that is a decade beyond the frequency of 95 %, the latter: a vibration or a jittering clock is no motion.
    Frequencies at which noise is not far below count for nothing. Speed, not acceleration, is weighed, because the
    square of frequency once more would let vibration and quantisation pass for motion.

    Args:
        q: shape (n, dof), positions on an even clock.
        rate: sample rate [Hz].
    """
    n = q.shape[0]
    straight, window = np.linspace(0.0, 1.0, n)[:, None], np.hanning(n)[:, None]
    swept = (q - q[0] - (q[-1] - q[0]) * straight) * window
    frequency = np.fft.rfftfreq(n, 1.0 / rate)
    by_noise = white_noise(q) ** 2 * np.sum(window**2)
    found = np.abs(np.fft.rfft(swept, axis=0)) ** 2
    power = np.where(uniform_filter1d(found, BINS, axis=0) > ABOVE * by_noise, found, 0.0) * frequency[:, None] ** 2
    moving = np.flatnonzero(np.std(q, axis=0) > 0.1 * np.max(np.std(q, axis=0)))
    if not moving.size:
        return 0.0
    usual, most = (np.median([_share_below(power[:, j], frequency, s) for j in moving]) for s in (SHARE, MOST_OF_IT))
    return float(most if usual > BEYOND * most else usual)


def _share_below(power: np.ndarray, frequency: np.ndarray, share: float) -> float:
    total = np.cumsum(power)
    highest = np.max(total, initial=0.0)
    if not highest > 0:
        return 0.0
    return float(frequency[np.argmax(total >= share * highest)])
