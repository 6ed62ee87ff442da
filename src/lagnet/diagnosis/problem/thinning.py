"""Samples at the rate that the band needs: of recordings at far more, every so many."""

from __future__ import annotations

from dataclasses import replace

from lagnet.recordings.conditioning.condition import Conditioned, Stretch
from lagnet.recordings.conditioning.smoothing import low_pass

FULL_RATE = 40.0  # samples per second over the bandwidth, beyond which laws gain nothing from more of them
LONG_RATE = 20.0  # of long recordings: twice what sets the low-pass apart from what it removes
LONG = 150_000  # samples at the full rate, from which recordings are long


def thinned(conditioned: Conditioned, fitted: Conditioned | None = None) -> Conditioned:
    """Samples at forty times the bandwidth where there are more; torques are low-passed before, against aliasing.

    Long recordings have half as many. Their length is that of the fitted ones, whose rate the held-out ones share.

    Args:
        conditioned: recordings on their even clock.
        fitted: those that are fitted, where these are not.
    """
    samples = sum(s.time.size for s in (fitted or conditioned).stretches)
    every = int(conditioned.rate / (FULL_RATE * conditioned.bandwidth))
    if samples > LONG * max(every, 1):
        every = int(conditioned.rate / (LONG_RATE * conditioned.bandwidth))
    if every < 2:
        return conditioned
    rate = conditioned.rate / every
    rows = slice(None, None, every)

    def part(s: Stretch) -> Stretch:
        tau = low_pass(s.tau, conditioned.rate, 0.4 * rate)
        drive = {name: x[rows] for name, x in s.drive.items()}
        return replace(s, time=s.time[rows], q=s.q[rows], v=s.v[rows], a=s.a[rows], tau=tau[rows], drive=drive)

    return replace(conditioned, rate=rate, stretches=tuple(map(part, conditioned.stretches)))
