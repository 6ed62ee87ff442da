"""Channels that stop changing half way."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lagnet.recordings.quality.check import QualityCheck, Subject
from lagnet.recordings.quality.finding import CERTAIN, LIKELY, Finding
from lagnet.recordings.quality.runs import constant_runs

LIVELY = 0.9  # of the samples elsewhere in which the channel changes
LONG = 0.3  # [s] for which it stands at least,
SAMPLES = 20  # and so many samples
ABRUPT = 8.0  # times the change of step that is usual: no joint stops from such a speed in one sample
COMMON = 0.99
MOST = 0.1  # of a recording that may be set aside before it is refused


class StuckChannels(QualityCheck):
    """A lively channel that takes one value from some sample on: a torque while its joint moves, or a position that
    stops from full speed within one sample."""

    name = "stuck_channels"
    title = "a channel is stuck for a while"
    meaning = "A joint that seems to stand while it moves is told as inertia and friction that are not there."

    def find(self, subject: Subject) -> Iterator[Finding]:
        for kind, values in subject.signals():
            for joint in np.flatnonzero(subject.moves):
                yield from self._of_channel(subject, kind, int(joint), values[:, joint])

    def _of_channel(self, subject: Subject, kind: str, joint: int, x: np.ndarray) -> Iterator[Finding]:
        least = max(SAMPLES, int(LONG * subject.recording.rate))
        for rows in subject.stretches:
            y = x[rows]
            runs = constant_runs(y)
            long = runs[(runs[:, 1] - runs[:, 0]) >= least] if len(runs) else runs
            inside = np.zeros(y.size, dtype=bool)
            for start, stop in long:
                inside[start:stop] = True
            elsewhere = np.diff(y)[~(inside[1:] & inside[:-1])]
            if not len(long) or elsewhere.size < least or np.mean(elsewhere != 0) < LIVELY:
                continue
            for start, stop in long:
                if self._is_stuck(subject, kind, joint, rows, y, elsewhere, int(start), int(stop)):
                    yield self._found(subject, kind, joint, rows[start:stop])

    def _is_stuck(
        self,
        subject: Subject,
        kind: str,
        joint: int,
        rows: np.ndarray,
        y: np.ndarray,
        steps: np.ndarray,
        start: int,
        stop: int,
    ) -> bool:
        if kind == "tau":
            q = subject.recording.q[rows, joint]
            if y[start] in (y.max(), y.min()):
                return False  # a limit of the drive or of the sensor, which another check tells
            moved = np.ptp(q[start:stop])
            return bool(moved > 0.1 * np.ptp(subject.recording.q[:, joint])) and np.ptp(steps) > 0
        usual = ABRUPT * float(np.quantile(np.abs(np.diff(steps)), COMMON)) if steps.size > 2 else np.inf
        before = abs(y[start] - y[start - 1]) if start > 0 else 0.0
        after = abs(y[stop] - y[stop - 1]) if stop < y.size else 0.0
        if kind == "v":
            return bool(abs(y[start]) > 0.0 and max(before, after) > usual and abs(y[start]) > 0.1 * np.ptp(y))
        return bool(max(before, after) > max(usual, 1e-9))

    def _found(self, subject: Subject, kind: str, joint: int, rows: np.ndarray) -> Finding:
        recording = subject.recording
        first, last = subject.span(rows)
        long = rows.size > MOST * len(recording)
        return self.found(
            subject,
            f"{subject.named(kind, joint)} keeps the value {getattr(recording, kind)[rows[0], joint]:.6g} from"
            f" {first:.6g} s to {last:.6g} s although the joint moves: the channel is stuck",
            "cut this part out of the file or record again" if long else "these samples were set aside",
            CERTAIN if kind != "v" else LIKELY,
            channel=f"{kind}_{joint}",
            rows=rows,
            set_aside=rows,
            harmful=long,
        )
