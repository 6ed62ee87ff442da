"""q, v, a, τ low-passed on an even clock, of some stretches, before the band of a diagnosis is chosen.

All bandwidths are shares of the sample rate and of the motion's own band, so that a clock in another unit changes the
unit alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.recordings.conditioning.noise import motion_bandwidth
from lagnet.recordings.conditioning.smoothing import SETTLING, derivative, even_clock, low_pass, resample
from lagnet.recordings.conditioning.stretches import stretches_of
from lagnet.recordings.recording import Recording

OVER_MOTION = 6.0  # bandwidth of the filter over that of the motion
OF_RATE = 0.2  # largest bandwidth over the sample rate
RECORDINGS = 4  # that are read
LONGEST = 6000  # samples of each
SHORTEST = 64  # samples


@dataclass(frozen=True, eq=False)
class Samples:
    """A stretch of motion: time (n,) [s]; q, v, a, tau (n, dof); smoothed alike, on an even clock."""

    time: np.ndarray
    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    tau: np.ndarray

    def rows(self, keep: np.ndarray | slice) -> Samples:
        """Some of the samples."""
        return Samples(self.time[keep], self.q[keep], self.v[keep], self.a[keep], self.tau[keep])


def smoothed_stretches(recordings: Sequence[Recording]) -> tuple[Samples, ...]:
    """The longest stretch of each of a few recordings; recordings that are too short have none."""
    every = max(1, len(recordings) // RECORDINGS)
    stretches = (_smoothed(recording) for recording in recordings[::every][:RECORDINGS])
    return tuple(samples for samples in stretches if samples is not None)


def _smoothed(recording: Recording) -> Samples | None:
    stretches = stretches_of(recording)
    if not stretches:
        return None
    used = recording.used(max(stretches, key=lambda rows: rows.stop - rows.start))
    used = used.rows(slice(0, LONGEST))
    rate = used.rate
    if len(used) < SHORTEST or not rate > 0 or (used.time[-1] - used.time[0]) * rate > 4 * LONGEST:
        return None
    clock = even_clock(used.time, rate)
    q, tau = resample(used.time, used.q, clock), resample(used.time, used.torque, clock)
    motion = motion_bandwidth(q, rate)
    band = min(OF_RATE * rate, OVER_MOTION * motion) if motion > 0 else OF_RATE * rate
    q = low_pass(q, rate, band)
    v = derivative(clock, q)
    a = derivative(clock, v)
    settle = int(np.ceil(SETTLING * rate / band))
    inner = slice(settle, -settle) if clock.size > 4 * settle else slice(None)
    return Samples(clock, q, v, a, low_pass(tau, rate, band)).rows(inner)


def thinned(samples: Sequence[Samples], most: int) -> Samples:
    """At most so many samples, evenly spread over all stretches, as one set and no time series."""
    total = sum(len(s.time) for s in samples)
    every = max(1, -(-total // most))
    parts = [s.rows(slice(every // 2, None, every)) for s in samples]
    return Samples(*(np.concatenate([getattr(p, name) for p in parts]) for name in ("time", "q", "v", "a", "tau")))
