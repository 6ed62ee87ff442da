"""τ(t + T) against q(t): a shift T between the stamps of torque and motion, the same for all joints."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.data_quality.check import EXPLAINED, LEAST_JOINTS, Evidence, Reading, ReadingCheck
from lagnet.diagnosis.data_quality.misfit import geometric_mean, misfits
from lagnet.diagnosis.data_quality.samples import Samples, thinned

LONGEST = 1.5  # [s]
LEAST = 0.15  # [s]: a smaller shift may be a delay of the drives, an effect of the catalogue
TRIED = 31  # shifts to either side
AGREE = 0.6  # share of joints whose misfit the shift must halve
CLOSE = 0.15  # of the shift: distance of a joint's own best shift from it
GAIN = 0.75  # largest misfit of a joint at the shift over that as recorded, for it to agree


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
        if abs(best / rate) < LEAST:
            return
        as_recorded = scores[min(scores, key=abs)]
        halved, agreeing = scores[best] < 0.5 * as_recorded, _agreeing(scores, best)
        explained = np.min(list(scores.values()), axis=0) < EXPLAINED
        agreed = agreeing.mean() >= LEAST_JOINTS and agreeing.sum() >= AGREE * explained.sum()
        if agreed or halved.mean() >= AGREE:
            misfits = scores[best] * evidence.misfits / np.maximum(as_recorded, 1e-12)
            yield self._reading(best, rate, misfits, agreeing if agreed else halved, agreed)

    def _reading(self, best: int, rate: float, misfits: np.ndarray, which: np.ndarray, agreed: bool) -> Reading:
        joints = "all" if which.all() else f"{which.sum()} of {which.size}"
        return Reading(
            self.name,
            "tau",
            misfits,
            f"the torques of {joints} joints are stamped about {abs(best) / rate:.3g} s"
            f" {'later' if best > 0 else 'earlier'} than the motion that they belong to",
            f"shift the torque columns by {abs(best)} rows, so that torque and motion stand side by side",
            agreed=bool(agreed),
        )


def _agreeing(scores: dict[int, np.ndarray], best: int) -> np.ndarray:
    """Joints that the model explains at this shift, better than as recorded, and whose own best shift is close to it.

    Args:
        scores: misfits of each joint at every shift in samples, shape (dof,) each.
        best: the shift.
    """
    shifts = np.array(list(scores))
    own = shifts[np.argmin(np.array(list(scores.values())), axis=0)]
    near = np.abs(own - best) <= max(1.0, CLOSE * abs(best))
    return near & (scores[best] < EXPLAINED) & (scores[best] < GAIN * scores[min(scores, key=abs)])


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
