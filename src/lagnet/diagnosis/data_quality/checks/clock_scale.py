"""Clock in another unit, t → s t: v → v / s and a → a / s², tested by the inertial torque."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from lagnet.diagnosis.data_quality.check import Evidence, Reading, ReadingCheck
from lagnet.diagnosis.data_quality.misfit import misfit_of, misfits_of
from lagnet.diagnosis.data_quality.samples import Samples

UNITS = {"minutes": 60.0, "hours": 3600.0, "milliseconds": 1e-3, "microseconds": 1e-6, "nanoseconds": 1e-9}
RATES = (10, 20, 25, 30, 40, 50, 60, 100, 120, 125, 200, 240, 250, 400, 500, 800, 1000, 2000, 4000)  # [Hz]
SLOWEST, FASTEST = 0.2, 5e-5  # [s] between samples of a recording in seconds


class ClockScale(ReadingCheck):
    """Recordings that fit the model when their clock is read in another unit: speeds over s, accelerations over s²."""

    name = "clock_scale"
    title = "the clock is in another unit"

    def readings(self, evidence: Evidence) -> Iterator[Reading]:
        step = float(evidence.series[0].time[1] - evidence.series[0].time[0])
        tried = [(f"in {unit}", factor) for unit, factor in UNITS.items()]
        tried += [(f"not in seconds: samples fit {rate} Hz", 1.0 / (rate * step)) for rate in RATES]
        found = [
            (misfit_of(evidence.model, scaled(evidence.few, factor)), what, factor)
            for what, factor in tried
            if FASTEST <= factor * step <= SLOWEST and not 0.8 < factor < 1.25
        ]
        for _, what, factor in sorted(found)[:2]:
            yield Reading(
                self.name,
                "time",
                misfits_of(evidence.model, scaled(evidence.many, factor)),
                f"the clock is {what}: accelerations as recorded do not fit the torques of any such arm",
                f"[scale] time = {factor:.6g}",
                1.0 if what.startswith("in ") else 1.2,
            )


def scaled(samples: Samples, factor: float) -> Samples:
    """The samples with their clock read in another unit."""
    return replace(samples, time=samples.time * factor, v=samples.v / factor, a=samples.a / factor**2)
