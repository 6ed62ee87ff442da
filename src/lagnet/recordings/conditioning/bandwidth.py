"""The bandwidth at which torques are compared: wide enough for the motion, narrow enough for noise twice derived."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from lagnet.recordings.conditioning.noise import band_noise, motion_bandwidth
from lagnet.recordings.conditioning.smoothing import SHORTEST, derivative, even_clock, low_pass, resample
from lagnet.recordings.conditioning.stretches import stretches_of
from lagnet.recordings.recording import Recording

OVER_MOTION = 12.0  # bandwidth over that of the motion: friction at reversals is quicker than the motion
LEAST, MOST = 5.0, 40.0  # [Hz] limits of the bandwidth
OF_RATE = 0.2  # of the sample rate: the most that a bandwidth may be
QUIET = 0.05  # noise of accelerations over the accelerations: beyond, a narrower band is taken
STEP = 0.85  # from one bandwidth to the next narrower one
STILL_OVER = 3.0  # times the motion's bandwidth that noise never narrows it below


def choose_bandwidth(recordings: Sequence[Recording], noise: Mapping[str, np.ndarray]) -> float:
    """Bandwidth [Hz] for torques: a multiple of the motion's, within what the sample rate and the noise allow.

    Args:
        noise: white noise of "q" and, where recorded, "v", shape (dof,).
    """
    rates = np.array([r.rate for r in recordings])
    found = [motion_bandwidth(*_longest_even(r)) for r in recordings if len(r) > SHORTEST]
    motion = float(np.median(found)) if found else 0.0
    widest = float(min(np.clip(OVER_MOTION * motion, LEAST, MOST), OF_RATE * rates.min()))
    return _quiet(recordings, noise, widest, min(widest, max(LEAST, STILL_OVER * motion)))


def _quiet(recordings: Sequence[Recording], noise: Mapping[str, np.ndarray], widest: float, narrowest: float) -> float:
    """The widest band in which accelerations of the median joint are far above what differentiation makes of noise."""
    usual = _accelerations(recordings, narrowest)
    moving = usual > 0.1 * usual.max() if usual.size else np.zeros(0, dtype=bool)
    rate, bandwidth = float(np.median([r.rate for r in recordings])), widest
    while moving.any() and bandwidth * STEP >= narrowest:
        share = _acceleration_noise(noise, rate, bandwidth)[moving] / usual[moving]
        if np.median(share) <= QUIET:
            break
        bandwidth *= STEP
    return bandwidth


def _acceleration_noise(noise: Mapping[str, np.ndarray], rate: float, bandwidth: float) -> np.ndarray:
    """What remains of the noise of positions or of recorded velocities, whichever is less, shape (dof,) [rad/s²]."""
    sources = [(noise[name], k) for name, k in (("q", 2), ("v", 1)) if name in noise]
    return np.min([band_noise(white, rate, bandwidth, k) for white, k in sources], axis=0)


def _accelerations(recordings: Sequence[Recording], bandwidth: float) -> np.ndarray:
    """Root mean square of the joints' accelerations below a frequency, shape (dof,) [rad/s²]."""
    powers = []
    for recording in recordings:
        q, rate = _longest_even(recording)
        if len(q) > SHORTEST:
            clock = np.arange(len(q)) / rate
            powers.append(np.mean(derivative(clock, derivative(clock, low_pass(q, rate, bandwidth))) ** 2, axis=0))
    return np.sqrt(np.mean(powers, axis=0)) if powers else np.zeros(0)


def _longest_even(recording: Recording) -> tuple[np.ndarray, float]:
    """Positions of the longest stretch on an even clock, and its rate: a jittering clock would look like motion."""
    used = recording.used(max(stretches_of(recording), key=lambda r: r.stop - r.start))
    return resample(used.time, used.q, even_clock(used.time, recording.rate)), recording.rate
