"""A spring with a damper beside it under a load: T de/dt + e = x."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from lagnet.recordings.sampling import is_even
from lagnet.types import Samples


def damped(time: Samples, signal: np.ndarray, constant: float) -> np.ndarray:
    """e(t) of T de/dt + e = x with e = x at the first sample, exact for x that is straight between samples, shape (n,).

    Args:
        time: increasing [s].
        signal: x, shape (n,).
        constant: T, not negative [s]; at zero e is x.
    """
    if constant <= 0.0 or len(time) < 2:
        return np.array(signal, dtype=float)
    steps = np.diff(time)
    ratio = constant / steps
    fade = np.exp(-1.0 / ratio)
    now, before = 1.0 - ratio * (1.0 - fade), ratio * (1.0 - fade) - fade  # weights of x_k and x_(k-1)
    push = now * signal[1:] + before * signal[:-1]
    start = float(signal[0])
    if is_even(time):
        rest, _ = lfilter([1.0], [1.0, -fade[0]], push, zi=[fade[0] * start])
        return np.concatenate([[start], rest])
    out = np.empty(len(time))
    out[0] = start
    for k, (a, x) in enumerate(zip(fade, push, strict=True)):
        out[k + 1] = a * out[k] + x
    return out
