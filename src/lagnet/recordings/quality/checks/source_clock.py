"""Samples that a log stamped with its own clock, while their source measured them on another."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lagnet.recordings.conditioning.stretches import stretches_of
from lagnet.recordings.quality.check import QualityCheck, Subject
from lagnet.recordings.quality.finding import CERTAIN, Finding
from lagnet.recordings.quality.repeated_rows import repeated_rows
from lagnet.recordings.quality.runs import runs_of
from lagnet.recordings.quality.source_clock import Clock, source_clock


class SourceClock(QualityCheck):
    """Positions that lie evenly on a clock from which the stamps are off: read twice, passed over, or stamped late."""

    name = "source_clock"
    title = "stamps are the log's, not the source's"
    meaning = "A sample read twice and the step behind it look like large accelerations, late stamps like rough motion."

    def find(self, subject: Subject) -> Iterator[Finding]:
        recording = subject.recording
        stale = _read_twice(subject)
        time, aside, found = recording.time.copy(), np.zeros(len(recording), dtype=bool), []
        usual = 1.0 / recording.rate if recording.rate else 0.0
        for rows in stretches_of(recording):
            within = np.arange(rows.start, rows.stop)
            kept = within[~stale[within] & (True if recording.valid is None else recording.valid[within])]
            clock = source_clock(recording.time[kept], recording.q[kept], usual)
            if clock is not None:
                found.append(clock)
                time[within] = _along(within, kept, clock)
                aside[within] = stale[within]
        if found:
            yield self.found(
                subject,
                _told(found, recording.rate, len(runs_of(aside))),
                "samples were put at the times of that clock; log the stamps of the source (header.stamp)",
                CERTAIN,
                set_aside=np.flatnonzero(aside),
                time=time,
            )


def _read_twice(subject: Subject) -> np.ndarray:
    """Rows that repeat the one before, by channels that change wherever anything does, shape (n,)."""
    table = np.hstack([values for _, values in subject.signals()])
    return repeated_rows(table, np.any(np.diff(table, axis=0) != 0, axis=1))


def _along(rows: np.ndarray, kept: np.ndarray, clock: Clock) -> np.ndarray:
    """Times of all rows of a stretch, shape (n,): those of the clock, and others evenly between them."""
    before, after = kept[0] - rows[rows < kept[0]], rows[rows > kept[-1]] - kept[-1]
    inside = np.interp(rows, kept, clock.time)
    inside[: before.size] -= clock.period * before
    inside[rows.size - after.size :] += clock.period * after
    return inside


def _told(found: list[Clock], rate: float, twice: int) -> str:
    """What was seen, in one sentence."""
    period = float(np.median([clock.period for clock in found]))
    passed = sum(clock.passed_over for clock in found)
    off = 1e3 * max(clock.spread for clock in found)
    places = [
        f"{twice} time{'s' * (twice != 1)} a sample was read twice" if twice else "",
        f"{passed} sample{'s were' if passed > 1 else ' was'} passed over" if passed else "",
    ]
    how = " and ".join(filter(None, places)) or "stamps scatter"
    return (
        f"the joints move as if measured at {1.0 / period:.5g} Hz, logged at {rate:.5g} Hz with stamps that range over"
        f" {off:.2g} ms around that clock: {how}"
    )
