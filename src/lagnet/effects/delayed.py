"""A signal as it was some time before, between its samples by a cubic spline."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import spline_filter1d

from lagnet.recordings.sampling import is_even
from lagnet.types import Samples

FEWEST = 4  # samples of a cubic spline
BEYOND = 20  # samples of the signal turned about its ends, which set the spline there; farther ones do not count


def earlier(time: Samples, signal: np.ndarray, delay: float) -> np.ndarray:
    """x(t − T) at each time; before the first sample and after the last the signal stays as it is there, shape (n,).

    On an even clock all samples lie at one place between two coefficients of the spline, so that four weights do for
    all of them: an eighth of the time of a spline that is asked anywhere.

    Args:
        time: increasing [s].
        signal: shape (n,).
        delay: T, of either sign [s].
    """
    if len(time) < FEWEST:
        return np.interp(time - delay, time, signal)
    if not is_even(time):
        return CubicSpline(time, signal)(np.clip(time - delay, time[0], time[-1]))
    return _shifted(signal, delay * (len(time) - 1) / (time[-1] - time[0]))


def _shifted(x: np.ndarray, samples: float) -> np.ndarray:
    """x_(i − s) for s samples, of either sign and not whole (Unser 1999, equation 4 and box 2)."""
    n, whole = len(x), int(np.ceil(samples))
    first, last = max(0, whole), min(n, n + int(np.floor(samples)))
    if first >= last:
        return np.full(n, x[0] if samples > 0.0 else x[-1])
    out = np.empty(n)
    out[:first], out[last:] = x[0], x[-1]
    beyond = min(n - 1, BEYOND)
    ends = np.pad(np.asarray(x, dtype=float), beyond, mode="reflect", reflect_type="odd")
    coefficients = spline_filter1d(ends, order=3, mode="mirror")[beyond + first - whole - 1 :]
    weights = enumerate(_cubic(whole - samples))
    out[first:last] = sum(w * coefficients[m : m + last - first] for m, w in weights)
    return out


def _cubic(f: float) -> tuple[float, float, float, float]:
    """Cubic B-splines of the coefficients before, at, after and two after a place that lies f behind a sample."""
    return (
        (1.0 - f) ** 3 / 6.0,
        (3.0 * f**3 - 6.0 * f**2 + 4.0) / 6.0,
        (1.0 + 3.0 * (f + f**2 - f**3)) / 6.0,
        f**3 / 6.0,
    )
