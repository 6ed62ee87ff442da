"""Event intervals: samples inside them are not valid for persistent effects."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from lagnet.diagnosis.problem.problem import Problem, Segment

SMEAR = 1.5  # periods of the bandwidth by which the filter widens an interval
MOST = 0.75  # of the valid samples that may be set aside, and of a recording: what acts for longer is how it is


@dataclass(frozen=True)
class EventInterval:
    """[t₀, t₁] of one recording in which no persistent effect, but a force or load on the last link, explains r.

    Args:
        recording: index among the fitted recordings, or among those held out.
        held_out: which of the two.
        start, end: [s] on the recording's clock.
        gain: log likelihood of the force or load over what an interval gains by chance [nats].
    """

    recording: int
    held_out: bool
    start: float
    end: float
    gain: float

    def covers(self, other: EventInterval, slack: float) -> bool:
        """Whether another event interval lies inside it, up to a slack [s] at both ends."""
        same = (self.recording, self.held_out) == (other.recording, other.held_out)
        return same and self.start - slack <= other.start and other.end <= self.end + slack


def set_aside(problem: Problem, events: Sequence[EventInterval]) -> Problem:
    """The problem with the samples of the event intervals made invalid, for all that persists."""
    slack = SMEAR / problem.bandwidth
    parts = {}
    for name, held_out in (("fit", False), ("holdout", True)):
        own = [s for s in events if s.held_out == held_out]
        parts[name] = tuple(_without(p, own, slack) for p in getattr(problem, name))
    return replace(problem, **parts)


def too_much(problem: Problem, masked: Problem) -> bool:
    """Whether so few valid samples remain that they can no longer be called the usual state of the arm."""
    return any(
        sum(p.counts.sum() for p in getattr(masked, name)) < (1.0 - MOST) * sum(p.counts.sum() for p in pieces)
        for name, pieces in (("fit", problem.fit), ("holdout", problem.holdout))
    )


def fills(problem: Problem, event: EventInterval) -> bool:
    """Whether an event covers so much of its recording that it does not stand out from the rest of it."""
    pieces = [p for p in (problem.holdout if event.held_out else problem.fit) if p.recording == event.recording]
    return event.end - event.start > MOST * float(pieces[-1].time[-1] - pieces[0].time[0])


def lasting(problem: Problem, events: Sequence[EventInterval]) -> Problem:
    """The problem less its event intervals; the whole where they cover so much that they are no exception."""
    masked = set_aside(problem, events)
    return problem if too_much(problem, masked) else masked


def _without(piece: Segment, events: Sequence[EventInterval], slack: float) -> Segment:
    time = piece.time[piece.keep]
    out = piece.counts
    for s in events:
        if s.recording == piece.recording:
            out = out & ~((time >= s.start - slack) & (time <= s.end + slack))[:, None]
    return piece if out is piece.counts else piece.with_counts(out)
