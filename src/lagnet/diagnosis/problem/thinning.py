"""Samples at the rate that the band needs: of recordings at far more, every so many."""

from __future__ import annotations

from dataclasses import replace

from lagnet.recordings.conditioning.condition import Conditioned, Stretch
from lagnet.recordings.conditioning.smoothing import low_pass

FULL_RATE = 40.0  # samples per second over the bandwidth, beyond which laws gain nothing from more of them


def thinned(conditioned: Conditioned) -> Conditioned:
    """Samples at forty times the bandwidth where there are more; torques are low-passed before, against aliasing."""
    every = int(conditioned.rate / (FULL_RATE * conditioned.bandwidth))
    if every < 2:
        return conditioned
    rate = conditioned.rate / every
    rows = slice(None, None, every)

    def part(s: Stretch) -> Stretch:
        tau = low_pass(s.tau, conditioned.rate, 0.4 * rate)
        drive = {name: x[rows] for name, x in s.drive.items()}
        return replace(s, time=s.time[rows], q=s.q[rows], v=s.v[rows], a=s.a[rows], tau=tau[rows], drive=drive)

    return replace(conditioned, rate=rate, stretches=tuple(map(part, conditioned.stretches)))
