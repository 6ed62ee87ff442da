"""Even clocks, zero-phase low-pass filters and derivatives by splines."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.signal import butter, sosfilt_zi

from lagnet.recordings.conditioning.compiled_filter import run_sections

ORDER = 4  # of the Butterworth filter, doubled by running forth and back
SETTLING = 2.0  # time for which the filter remembers an edge, in periods of its bandwidth
SHORTEST = 32  # samples below which a stretch is left out: too short for the filter's edges


def low_pass(x: np.ndarray, rate: float, bandwidth: float) -> np.ndarray:
    """Passes what is slower than the bandwidth, without phase shift.

    Args:
        x: shape (n,) or (n, k), samples on an even clock.
        rate: sample rate [Hz].
        bandwidth: cut-off [Hz], half power of one of the two passes; at or above 0.45 rate nothing is filtered.

    The same as `scipy.signal.sosfiltfilt`, which computes the filter's state at rest anew in every call: on a few
    columns that takes as long as the filter.
    """
    if bandwidth >= 0.45 * rate or x.shape[0] < SHORTEST:
        return x
    pad = min(x.shape[0] - 1, max(3 * (2 * ORDER + 1), int(2.0 * rate / bandwidth)))
    flat = x.reshape(x.shape[0], -1)
    wide = np.empty((x.shape[0] + 2 * pad, flat.shape[1]))
    wide[:pad], wide[-pad:] = 2.0 * flat[:1] - flat[pad:0:-1], 2.0 * flat[-1:] - flat[-2 : -pad - 2 : -1]
    wide[pad:-pad] = flat
    for backwards in (False, True):
        run_sections(wide, *_sections(rate, bandwidth), backwards)
    return wide[pad:-pad].reshape(x.shape)


@lru_cache(maxsize=64)
def _sections(rate: float, bandwidth: float) -> tuple[np.ndarray, np.ndarray]:
    """The filter's second-order sections and their state at rest; a diagnosis asks for the same thousands of times."""
    sections = np.asarray(butter(ORDER, bandwidth, fs=rate, output="sos"))
    return sections, np.asarray(sosfilt_zi(sections))


def even_clock(time: np.ndarray, rate: float) -> np.ndarray:
    """Evenly spaced times [s] from the first sample to the last."""
    steps = int(np.floor((time[-1] - time[0]) * rate + 1e-6))
    return time[0] + np.arange(steps + 1) / rate


def resample(time: np.ndarray, x: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Values between samples by a cubic spline, shape (n_at, k); exact where the times coincide."""
    if time.size == at.size and np.allclose(time, at, rtol=0.0, atol=1e-9 * max(1.0, abs(time[-1]))):
        return x
    keep = np.diff(time, prepend=-np.inf) > 0  # of samples with one and the same time the first counts
    time, x = time[keep], x[keep]
    return make_interp_spline(time, x, k=min(3, time.size - 1), axis=0)(np.clip(at, time[0], time[-1]))


def derivative(time: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Rate of change of smooth samples by a quintic spline, shape as x; error of order (ω Δt)⁶."""
    return make_interp_spline(time, x, k=min(5, time.size - 1), axis=0).derivative()(time)
