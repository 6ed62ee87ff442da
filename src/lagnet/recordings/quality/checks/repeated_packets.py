"""Packets that were lost and written as a copy of the one before."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lagnet.recordings.quality.check import QualityCheck, Subject
from lagnet.recordings.quality.finding import CERTAIN, Finding
from lagnet.recordings.quality.repeated_rows import repeated_rows
from lagnet.recordings.quality.runs import runs_of

MOVING = 0.5  # of the median step around: the joint was on its way when it seemed to stand
AROUND = 5  # samples on both sides
MOST = 0.3  # of the rows: beyond, signals are held, which another check tells


class RepeatedPackets(QualityCheck):
    """Rows that repeat the one before in every lively channel, to the last digit, while the arm moves."""

    name = "repeated_packets"
    title = "lost packets were written as copies"
    meaning = "A standstill of one sample and the step behind it look like large accelerations."

    def find(self, subject: Subject) -> Iterator[Finding]:
        table = np.hstack([values for _, values in subject.signals()])
        copied = repeated_rows(table, np.ones(max(0, len(table) - 1), dtype=bool))
        copied &= _moving(subject.recording.q)
        copied[np.flatnonzero(np.diff(subject.recording.trajectory)) + 1] = False
        if subject.recording.valid is not None:
            copied &= subject.recording.valid
        rows = np.flatnonzero(copied)
        if not rows.size or rows.size > MOST * len(table):
            return
        runs = runs_of(copied)
        yield self.found(
            subject,
            f"{rows.size} sample{'s repeat' if rows.size > 1 else ' repeats'} the one before in all columns while the"
            f" arm moves ({len(runs)} place{'s' * (len(runs) > 1)}, the first at"
            f" t = {subject.recording.time[rows[0]]:.6g} s): lost packets written as copies",
            "these samples were set aside; leave lost rows out of the file",
            CERTAIN,
            rows=rows,
            set_aside=rows,
        )


def _moving(q: np.ndarray) -> np.ndarray:
    """Whether some joint was on its way at each sample, shape (n,): its steps around are as large as usual."""
    steps = np.abs(np.diff(q, axis=0, prepend=q[:1]))
    usual = np.median(steps, axis=0)
    quick = np.pad(steps > MOVING * usual, ((AROUND + 1, AROUND), (0, 0)), mode="edge").cumsum(axis=0)
    window = 2 * AROUND + 1
    most = quick[window:] - quick[:-window] > AROUND  # a median exceeds what more than half of the values exceed
    return np.any(most & (usual > 0), axis=1)
