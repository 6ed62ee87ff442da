"""Packets that were lost and written as zeros."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lagnet.recordings.quality.check import QualityCheck, Subject
from lagnet.recordings.quality.finding import CERTAIN, Finding
from lagnet.recordings.quality.runs import runs_of

AWAY = 8.0  # times the usual step: a joint that was so far from zero a sample before does not reach it by moving
JOINTS = 0.3  # of the joints, at least, that are so far away
MOST = 0.2  # of the samples that may be lost before the recording is refused


class LostPackets(QualityCheck):
    """Rows in which every signal is exactly zero although most were far from zero before and after."""

    name = "lost_packets"
    title = "lost packets were written as zeros"
    meaning = "Jumps to zero and back look like large accelerations: a heavier link, a saturation."

    def find(self, subject: Subject) -> Iterator[Finding]:
        recording = subject.recording
        kinds = [kind for kind, _ in subject.signals()]
        lost = _fallen(np.hstack([values for _, values in subject.signals()]), recording.q)
        runs = runs_of(lost)
        if not len(runs):
            return
        rows = np.flatnonzero(lost)
        times = "once" if len(runs) == 1 else f"{len(runs)} times"
        yield self.found(
            subject,
            f"all columns of {' and '.join(kinds)} fall to exactly zero and come back {times} ({rows.size} samples,"
            f" the first at t = {recording.time[rows[0]]:.6g} s): lost packets written as zeros",
            "these samples were set aside; leave lost rows out of the file",
            CERTAIN,
            channel=" ".join(kinds),
            rows=rows,
            set_aside=rows,
            harmful=rows.size > MOST * len(recording),
        )


def _fallen(values: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Rows of zeros beside which positions are further from zero than joints move in a sample, shape (n,)."""
    zero = (values == 0).all(axis=1)
    out = np.zeros(len(values), dtype=bool)
    if not zero.any() or zero.all():
        return out
    steps = np.abs(np.diff(q, axis=0))[~(zero[1:] | zero[:-1])]
    usual = np.quantile(steps, 0.9, axis=0) if len(steps) else np.zeros(q.shape[1])
    for start, stop in runs_of(zero):
        sides = [q[k] for k in (start - 1, stop) if 0 <= k < len(q)]
        if all(np.sum(np.abs(side) > AWAY * usual) >= max(1.0, JOINTS * q.shape[1]) for side in sides):
            out[start:stop] = True
    return out
