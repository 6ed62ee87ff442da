"""Torques cut off at the end of their sensor's or converter's range."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lagnet.recordings.quality.check import QualityCheck, Subject
from lagnet.recordings.quality.finding import LIKELY, Finding
from lagnet.recordings.quality.runs import constant_runs

AT_END = 0.005  # of the samples that are exactly the largest or the smallest
RUNS = 3  # at least, of several samples each
LONG = 4  # samples of such a run
QUANTA = 200  # values that the channel takes at least: a coarse scale meets its ends by chance


class SensorSaturation(QualityCheck):
    """A torque that stays exactly at its largest or smallest value, time and again, although it is finely resolved."""

    name = "sensor_saturation"
    title = "a torque is cut off at the end of its range"
    meaning = "What the sensor cuts off looks like a motor that gives no more."

    def find(self, subject: Subject) -> Iterator[Finding]:
        if not subject.recording.has_torque:
            return
        tau = subject.recording.torque
        for joint in np.flatnonzero(subject.moves):
            x = tau[:, joint]
            if np.unique(x).size < QUANTA:
                continue
            for end in (float(x.max()), float(x.min())):
                rows = np.flatnonzero(x == end)
                runs = constant_runs(np.where(x == end, 0.0, np.arange(1, x.size + 1)))
                long = runs[runs[:, 1] - runs[:, 0] >= LONG] if len(runs) else runs
                if rows.size > AT_END * x.size and len(long) >= RUNS:
                    yield self._found(subject, int(joint), end, rows)

    def _found(self, subject: Subject, joint: int, end: float, rows: np.ndarray) -> Finding:
        return self.found(
            subject,
            f"{subject.named('tau', joint)} stays at exactly {end:.6g}, the end of its range, in {rows.size} samples:"
            " the sensor, the converter or the drive cuts it off",
            "widen the range of the measurement; if it is the drive that gives no more, this is a saturation",
            LIKELY,
            channel=f"tau_{joint}",
            rows=rows,
        )
