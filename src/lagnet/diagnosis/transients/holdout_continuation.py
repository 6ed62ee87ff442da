"""Hold-out continuation: transients that still act when the held-out part of their recording begins."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from lagnet.diagnosis.problem.intervals import SMEAR, EventInterval
from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.transients.transient import Transient


def carry_on(
    problem: Problem, transients: Sequence[Transient], unnamed: Sequence[EventInterval]
) -> tuple[tuple[Transient, ...], tuple[EventInterval, ...]]:
    """Effects that continue into the held-out part of their recording, and the events that they do not explain."""
    out, remaining = [], list(unnamed)
    for one in transients:
        found = [s for s in remaining if _continues(problem, one, s)]
        out.append(_until(one, found[0].end, problem.rate) if found else one)
        remaining = [s for s in remaining if s not in found]
    return tuple(out), tuple(remaining)


def _continues(problem: Problem, transient: Transient, event: EventInterval) -> bool:
    """Whether a held-out event begins where the fitted part of the effect's recording ends with the effect."""
    fitted = [p for p in problem.fit if p.recording == transient.effect.recording]
    held = [p for p in problem.holdout if p.recording == event.recording and p.origin == transient.effect.recording]
    if not (event.held_out and fitted and held and transient.effect.interval):
        return False
    slack = SMEAR / problem.bandwidth
    to_the_end = transient.effect.interval[1] > fitted[-1].time[fitted[-1].keep[-1]] - slack
    return bool(to_the_end and event.start < held[0].time[held[0].keep[0]] + slack)


def _until(transient: Transient, end: float, rate: float) -> Transient:
    """The same effect with a later end, known to one period of the scanned samples."""
    start = transient.effect.interval[0] if transient.effect.interval else end
    intervals = {**transient.intervals, "t1": (end - 1.0 / rate, end + 1.0 / rate)}
    return replace(transient, effect=replace(transient.effect, interval=(start, end)), intervals=intervals)
