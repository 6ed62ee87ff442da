"""τ(t + T) against q(t): a shift T between the stamps of torque and motion, the same for all joints."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.data_quality.check import Evidence, Reading, ReadingCheck
from lagnet.diagnosis.data_quality.misfit import geometric_mean, misfits
from lagnet.diagnosis.data_quality.samples import Samples, thinned

LONGEST = 1.5  # [s]
LEAST = 0.15  # [s]: a smaller shift may be a delay of the drives, an effect of the catalogue
TRIED = 31  # shifts to either side
AGREE = 0.6  # share of joints whose misfit the shift must halve


class TorqueLag(ReadingCheck):
    """Torques of all joints that fit the model at another time, the same for all."""

    name = "torque_lag"
    title = "torque and motion are stamped at different times"
    always = True

    def readings(self, evidence: Evidence) -> Iterator[Reading]:
        rate = 1.0 / float(evidence.series[0].time[1] - evidence.series[0].time[0])
        most = min(int(LONGEST * rate), min(len(s.time) for s in evidence.series) // 4)
        if most < 4:
            return
        model = [evidence.model.inverse_dynamics(s.q, s.v, s.a) for s in evidence.series]
        scores = {
            k: _shifted(evidence.series, model, k)
            for k in np.unique(np.linspace(-most, most, 2 * TRIED + 1).astype(int))
        }
        best = min(scores, key=lambda k: geometric_mean(scores[k]))
        fine = range(best - most // TRIED, best + most // TRIED + 1)
        scores |= {k: _shifted(evidence.series, model, k) for k in fine if abs(k) <= most and k not in scores}
        best = min(scores, key=lambda k: geometric_mean(scores[k]))
        lag = best / rate
        agree = np.mean(scores[best] < 0.5 * scores[min(scores, key=abs)])
        if abs(lag) < LEAST or agree < AGREE:
            return
        way = "later" if lag > 0 else "earlier"
        yield Reading(
            self.name,
            "tau",
            float(
                geometric_mean(scores[best])
                * evidence.as_recorded
                / max(geometric_mean(scores[min(scores, key=abs)]), 1e-12)
            ),
            f"the torques of {'all' if agree == 1 else 'most'} joints are stamped about {abs(lag):.3g} s {way} than the"
            " motion that they belong to",
            f"shift the torque columns by {abs(best)} rows, so that torque and motion stand side by side",
        )


def _shifted(series: tuple[Samples, ...], model: list[np.ndarray], shift: int) -> np.ndarray:
    """Misfit of each joint with torques read so many samples later, shape (dof,)."""
    parts, modelled = [], []
    for samples, torque in zip(series, model, strict=True):
        n = len(samples.time)
        motion, later = np.arange(max(0, -shift), n - max(0, shift)), np.arange(max(0, shift), n + min(0, shift))
        every = max(1, motion.size // 500)
        motion, later = motion[::every], later[::every]
        parts.append(replace(samples.rows(motion), tau=samples.tau[later]))
        modelled.append(torque[motion])
    joined = thinned(parts, sum(len(p.time) for p in parts))
    return misfits(joined, np.concatenate(modelled))
