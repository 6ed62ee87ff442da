"""Clocks that count something other than seconds."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lagnet.recordings.quality.check import QualityCheck, Subject
from lagnet.recordings.quality.finding import CERTAIN, Finding

SLOWEST = 1.5  # [s] between samples: no speed can be had from so few
FASTEST = 2e-5  # [s]: no robot is recorded so often
WHOLE = 1e-6  # of a step that numbers of samples may be off


class ClockUnit(QualityCheck):
    """A median step that no recording of a robot has, or steps of exactly one."""

    name = "clock_unit"
    title = "the clock is not in seconds"
    meaning = "Speeds and accelerations are then off by the same factor: inertia and friction mean nothing."

    def find(self, subject: Subject) -> Iterator[Finding]:
        recording = subject.recording
        steps = np.diff(recording.time)[np.diff(recording.trajectory) == 0]
        if not steps.size:
            return
        step = float(np.median(steps))
        if abs(step - 1.0) < WHOLE and np.all(np.abs(steps - np.round(steps)) < WHOLE):
            yield self.found(
                subject,
                "the time stamps are whole numbers one apart: numbers of samples, or milliseconds at 1 kHz",
                "[scale] time = 0.01 for a recording of 100 Hz (one over its rate)",
                CERTAIN,
                channel="time",
                harmful=True,
            )
        elif step >= SLOWEST:
            unit, factor = _finer(step)
            yield self.found(
                subject,
                f"a sample every {step:.4g} s: the clock most likely counts {unit}",
                f"[scale] time = {factor:g}",
                CERTAIN,
                channel="time",
                harmful=True,
            )
        elif step <= FASTEST:
            yield self.found(
                subject,
                f"a sample every {step:.3g} s ({1 / step:.3g} Hz): the clock most likely counts minutes or hours",
                "[scale] time = 60",
                CERTAIN,
                channel="time",
                harmful=True,
            )


def _finer(step: float) -> tuple[str, float]:
    """Unit in which a step is one of a recording between 10 Hz and 10 kHz."""
    for unit, factor in (("milliseconds", 1e-3), ("microseconds", 1e-6), ("nanoseconds", 1e-9)):
        if 1e-4 <= step * factor <= 0.2:
            return unit, factor
    return "another unit than seconds", 1e-3
