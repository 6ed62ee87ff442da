"""Transient laws of event intervals, refitted together with the persistent effects; intervals that no law explains."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.estimation.intervals.misspecification import Intervals
from lagnet.diagnosis.estimation.refit import Refit, refit
from lagnet.diagnosis.problem.intervals import EventInterval, fills, set_aside
from lagnet.diagnosis.problem.problem import OVERSAMPLING, Problem
from lagnet.diagnosis.problem.residuals import residual_by_recording
from lagnet.diagnosis.transients.detection import SHORTEST, Scan
from lagnet.diagnosis.transients.fitting import BEYOND, EventFit, fit_event
from lagnet.diagnosis.transients.holdout_continuation import carry_on
from lagnet.diagnosis.transients.transient import Transient
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import EDGES, NamedEffect

MOST_RESIDUAL = 0.25  # of the power inside an interval: a law with a larger residual is rejected
HELPS = 0.5  # of the error inside an interval that must remain at most, on parts that were not fitted
UNNAMED = 3000.0  # nats of an interval that no law explains, below which it may be a burst of persistent physics
ELSEWHERE = 10.0  # nats that joints other than the strongest must add: no force on the tool moves one joint alone
LEAST_ELSEWHERE = 0.01  # of all nats
RESOLVED = 1.0  # periods of the low-pass: what is shorter has its shape, whatever it was
NOTICED = 0.01  # of the torque: transients smaller than this are not claimed


@dataclass(frozen=True, eq=False)
class Separated:
    """Persistent effects, transients with a name, and intervals without one."""

    refit: Refit
    transients: tuple[Transient, ...]
    unnamed: tuple[EventInterval, ...]


def separate(problem: Problem, persistent: Sequence[NamedEffect], sigma: np.ndarray, scan: Scan) -> Separated:
    """Fits every interval of a fitted recording, and takes those that a law explains to the persistent effects.

    Args:
        problem: with the samples of the intervals.
        persistent: effects that act always, found without those samples.
        sigma: shape (dof,), what they leave at each joint [N m].
        scan: the intervals.
    """
    good, unnamed = _good_and_unnamed(problem, persistent, sigma, scan)
    together = refit(set_aside(problem, unnamed), (*persistent, *(f.effect for _, f in good)), sigma)
    n = len(persistent)
    found = []
    for fitted, intervals, (event, fit) in zip(together.effects[n:], together.intervals[n:], good, strict=True):
        wide = _widened(intervals, _caution(fit, scan.inflation), problem.rate)
        effect, wide = within_recording(problem, fitted, wide)
        if effect_named(effect.effect).is_determined(wide) and is_resolved(effect, problem.bandwidth):
            found.append(Transient(effect, wide, fit, 0.0))
        elif event.gain > UNNAMED:
            unnamed = (*unnamed, event)
    of_persistent = Refit(together.effects[:n], together.intervals[:n], together.correlations)
    shares = _shares(problem, of_persistent.effects, [p.effect for p in found])
    shared = [replace(p, share=s) for p, s in zip(found, shares, strict=True)]
    return Separated(of_persistent, *carry_on(problem, shared, unnamed))


def _good_and_unnamed(
    problem: Problem, persistent: Sequence[NamedEffect], sigma: np.ndarray, scan: Scan
) -> tuple[list[tuple[EventInterval, EventFit]], tuple[EventInterval, ...]]:
    """Intervals that a law explains, with its fit; and those that neither a law nor what lasts explains."""
    pairs = [(s, fit_event(problem, persistent, s, scan)) for s in scan.events if not s.held_out]
    good = [(s, f) for s, f in pairs if _convinces(f)]
    lasting = [s for s, _ in good if not _stands_beside(problem, persistent, sigma, s, scan)]
    good = [(s, f) for s, f in good if not any(s is t for t in lasting)]
    explained = (*lasting, *_bursts(pairs), *(s for s, _ in good))
    others = (s for s in scan.events if not any(s is t for t in explained))
    return good, tuple(s for s in others if s.held_out or s.gain > UNNAMED)


def within_recording(problem: Problem, effect: NamedEffect, intervals: Intervals) -> tuple[NamedEffect, Intervals]:
    """The effect with edges at most a little beyond its recording: what lies further out is no estimate."""
    times = [t for p in problem.fit if p.recording == effect.recording for t in (p.time[0], p.time[-1])]
    beyond, edges = BEYOND / problem.rate, effect.interval or (min(times), max(times))
    start, end = (float(t) for t in np.clip(edges, min(times) - beyond, max(times) + beyond))
    moved = {name: (t, t) for name, t, was in zip(EDGES, (start, end), edges, strict=True) if t != was}
    return replace(effect, interval=(start, end)), {**intervals, **moved}


def _stands_beside(
    problem: Problem, persistent: Sequence[NamedEffect], sigma: np.ndarray, event: EventInterval, scan: Scan
) -> bool:
    """Whether what acts all along a recording also does where all that lasts is fitted to that recording, too.

    Laws of the other recordings alone are extrapolated to it, and may leave there what they need not. What acts for
    a while stands out from the rest of its recording. Where something acts all along every recording, no law is of
    others alone.
    """
    filled = {s.recording for s in scan.events if not s.held_out and fills(problem, s)}
    if event.recording not in filled or filled == {p.recording for p in problem.fit}:
        return True
    known = set_aside(problem, [s for s in scan.events if s is not event])
    return _convinces(fit_event(problem, refit(known, persistent, sigma).effects, event, scan))


def _convinces(fit: EventFit) -> bool:
    gain = fit.without - fit.with_it
    return (
        fit.residual_share < MOST_RESIDUAL
        and fit.with_it < HELPS * fit.without
        and gain > NOTICED**2
        and not _local(fit)
    )


def is_resolved(effect: NamedEffect, bandwidth: float) -> bool:
    """Whether an event is longer than a period of the low-pass, and than a burst of disturbance may be.

    A shorter one may be an outlier as well as a push. Edges that were fitted may have moved closer than those found.
    """
    start, end = effect.interval or (-np.inf, np.inf)
    return end - start >= max(RESOLVED / bandwidth, SHORTEST)


def _local(fit: EventFit) -> bool:
    """Whether the gain comes from one joint alone: a force or a load on the last link acts on others, too."""
    return fit.elsewhere < max(ELSEWHERE, LEAST_ELSEWHERE * float(np.sum(fit.gains)))


def _bursts(pairs: Sequence[tuple[EventInterval, EventFit]]) -> list[EventInterval]:
    """Events that recur at one joint alone: persistent physics there, in poses that the arm takes now and then."""
    local = [(s, f.strongest) for s, f in pairs if _local(f)]
    joints = [j for _, j in local]
    return [s for s, j in local if joints.count(j) > 1]


def _widened(intervals: Intervals, factor: float, rate: float) -> Intervals:
    """Wider intervals, where residuals are correlated in time and an event has too few blocks to show it.

    The first sample inside may come up to one sample after the start, and the last one before the end.
    """
    out = {}
    for name, (low, high) in intervals.items():
        grown = 0.5 * (factor - 1.0) * (high - low)
        before, after = (1.0 / rate if name == edge else 0.0 for edge in EDGES)
        out[name] = (low - grown - before, high + grown + after)
    return out


def _caution(fit: EventFit, inflation: float) -> float:
    """Factor on the half-width of intervals: √(statistical inefficiency of filter and residual · remaining power)."""
    return float(np.sqrt(0.5 * OVERSAMPLING * inflation * max(1.0, fit.over_usual)))


def _shares(problem: Problem, persistent: Sequence[NamedEffect], transient: Sequence[NamedEffect]) -> list[float]:
    """Power that each explains, over that of the nominal residual, joints weighted by their torque."""
    nominal = _power(problem, ())
    with_all = _power(problem, (*persistent, *transient))
    return [
        float(
            np.clip(
                (_power(problem, (*persistent, *(p for p in transient if p is not e))) - with_all) / nominal, 0.0, 1.0
            )
        )
        for e in transient
    ]


def _power(problem: Problem, effects: Sequence[NamedEffect]) -> float:
    all_series = residual_by_recording(problem, problem.fit, effects)
    return max(float(sum(np.sum((s.residual * s.valid / problem.scale) ** 2) for s in all_series)), 1e-300)
