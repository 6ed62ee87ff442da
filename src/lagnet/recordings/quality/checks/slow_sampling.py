"""Motion too quick for the rate at which it was recorded."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lagnet.percent import percent
from lagnet.recordings.quality.check import QualityCheck, Subject
from lagnet.recordings.quality.finding import LIKELY, Finding
from lagnet.recordings.quality.interpolation import off_neighbours
from lagnet.recordings.quality.runs import resolution

LOST = 0.3  # of a joint's step from sample to sample: further off, its speed between samples is not known
JOINTS = 0.5  # of the moving joints
QUANTA = 10.0  # steps of the scale that a joint must go from sample to sample, or its scale is what is seen
FEW = 16  # samples of a stretch, or steps, below which nothing is said


class SlowSampling(QualityCheck):
    """Samples that do not lie on the curve of their neighbours, all along: half of the speeds is not recorded.

    A sample is predicted by the cubic through two neighbours on either side; where the error is a good part of
    the way from one sample to the next, the speed between samples is not known.
    """

    name = "slow_sampling"
    title = "the rate is too low for the motion"
    meaning = "Speeds and accelerations cannot be had from so few samples: friction and inertia come out wrong."

    def find(self, subject: Subject) -> Iterator[Finding]:
        q, time = subject.recording.q, subject.recording.time
        share = np.array([_share(subject, time, q[:, j]) for j in np.flatnonzero(subject.moves)])
        moving = share[~np.isnan(share)]
        if not moving.size:
            return
        if np.mean(moving > LOST) > JOINTS:
            yield self.found(
                subject,
                f"at {subject.recording.rate:.4g} Hz positions do not follow from those of neighbouring samples (off by"
                f" {percent(float(np.median(moving)))} of the step between them): the motion is too quick for the"
                " rate, or the positions are mostly noise",
                "record at a rate of at least ten times the highest frequency of the motion",
                LIKELY,
                channel="time",
                harmful=True,
            )


def _share(subject: Subject, time: np.ndarray, q: np.ndarray) -> float:
    """Distance of samples from the curve of their neighbours over the step between them; NaN where nothing is seen."""
    off, way = [], []
    for rows in subject.stretches:
        if rows.size >= FEW:
            inner = np.arange(2, rows.size - 2)
            off.append(off_neighbours(time[rows], q[rows], inner))
            way.append(np.diff(q[rows])[1:-2])
    if not off:
        return float("nan")
    errors, steps = np.abs(np.concatenate(off)), np.abs(np.concatenate(way))
    moved = steps > QUANTA * resolution(np.concatenate([q[rows] for rows in subject.stretches]))
    return float(np.median(errors[moved] / steps[moved])) if moved.sum() > FEW else float("nan")
