"""Positions that jump and stay: an encoder that lost counts, or two recordings glued together."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lagnet.recordings.quality.check import QualityCheck, Subject
from lagnet.recordings.quality.finding import LIKELY, Finding
from lagnet.recordings.quality.runs import resolution

ABRUPT = 20.0  # times the usual change of step (99 % of samples stay under it)
COMMON = 0.99
LEAST = 0.02  # of the channel's range
QUANTA = 10.0  # steps of a coarse scale
AROUND = 6  # samples on both sides: outside of the jump the joint moves as ever
FASTER = 5.0  # times the joint's largest usual speed, and its limit, that the jump would need
MOST = 20  # jumps of one channel: more are no jumps of a sound channel but another fault


class PositionSteps(QualityCheck):
    """A position that goes further between two samples than the joint's speed allows, and goes on from there."""

    name = "position_steps"
    title = "a position jumps"
    meaning = "A jump of an encoder is told as an impact, and what follows as another zero of the joint."

    def find(self, subject: Subject) -> Iterator[Finding]:
        q, time = subject.recording.q, subject.recording.time
        for joint in np.flatnonzero(subject.moves):
            steps = [_steps(time[rows], q[rows, joint], subject.limits.velocity[joint]) for rows in subject.stretches]
            at = [int(rows[k]) for rows, found in zip(subject.stretches, steps, strict=True) for k in found]
            if not at or len(at) > MOST:
                continue
            first = at[0]
            yield self.found(
                subject,
                f"{subject.named('q', int(joint))} jumps by {q[first + 1, joint] - q[first, joint]:.4g} between two"
                f" samples at t = {time[first]:.6g} s"
                + (f" and {len(at) - 1} times more" if len(at) > 1 else "")
                + " and stays there: the encoder lost its place, or two recordings were joined",
                "split the recording there with a trajectory column; if the zero changed, correct it with"
                f' [offset] "q_{joint}" = ...',
                LIKELY,
                channel=f"q_{joint}",
                rows=np.array(at),
            )


def _steps(time: np.ndarray, q: np.ndarray, limit: float) -> np.ndarray:
    """Indices k such that the joint jumps between k and k + 1."""
    if q.size < 4 * AROUND:
        return np.zeros(0, dtype=np.int64)
    step = np.diff(q)
    speed = np.abs(step / np.diff(time))
    usual = float(np.quantile(speed, COMMON))
    change = np.abs(np.diff(step))
    least = max(
        ABRUPT * float(np.quantile(change, COMMON)),
        LEAST * float(np.ptp(np.quantile(q, [0.01, 0.99]))),
        QUANTA * resolution(q),
    )
    fast = (speed > FASTER * usual) & (speed > (FASTER * limit if np.isfinite(limit) else 0.0)) & (np.abs(step) > least)
    at = np.flatnonzero(fast)
    alone = [k for k in at if not fast[max(0, k - AROUND) : k].any() and not fast[k + 1 : k + 1 + AROUND].any()]
    return np.array(alone, dtype=np.int64)
