"""Recordings that differ: a load of its own in each, where events are no exception but fill whole recordings.

One load cannot explain recordings in which it was mounted differently: what fits them all is a compromise, and what is
left of it fills each recording from its first sample to its last. A recording that is held out carries the load of the
fitted one that explains it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from lagnet.diagnosis.problem.intervals import EventInterval, fills
from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.diagnosis.problem.residuals import residual_by_recording
from lagnet.diagnosis.transients.detection import Scan
from lagnet.diagnosis.transients.least_left import may_have_load
from lagnet.diagnosis.transients.separation import Separated, separate
from lagnet.diagnosis.transients.transient import Transient
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import NamedEffect, torque_with

MANY = 12  # recordings, beyond which groups are not looked for: each load has twelve parameters, fitted together
FALLS = 0.5  # of the squared held-out error, joints weighted by their noise, that must remain at most


@dataclass(frozen=True, eq=False)
class Differing:
    """Loads of single recordings.

    Args:
        problem: each held-out recording as a part of the fitted one whose load it carries.
        loads: one for each recording that differs, from its first sample to the last that is held out.
        scan: the intervals that they were found in.
    """

    problem: Problem
    loads: tuple[NamedEffect, ...]
    scan: Scan


def differing_recordings(problem: Problem, scan: Scan, effects: Sequence[NamedEffect]) -> Differing | None:
    """A load for each fitted recording that an event fills; None where there is one recording only, or no such load.

    Nor where two of the loads are one: what these recordings share is not how they differ.

    Args:
        problem: with all samples valid.
        scan: events beside the effects that were found on all recordings together.
        effects: these; friction and whatever else acts on the motion of a joint is there beside the loads.
    """
    whole = [_whole(problem, e.recording, e.gain) for e in scan.events if not e.held_out and fills(problem, e)]
    found, of_all = _with_own_loads(problem, whole, scan, effects)
    alike = any(are_alike(one, other) for one, other in combinations(found, 2))
    return None if alike or len(found) < len(whole) else of_all


def differing_groups(problem: Problem, scan: Scan, effects: Sequence[NamedEffect]) -> Differing | None:
    """A load for each fitted recording that has one; None where none has, or all have the same.

    Of recordings in groups, such as some without a tool and some with it, none stands out. Arguments as above.
    """
    recordings = sorted({p.recording for p in problem.fit})
    if len(recordings) > MANY:
        return None
    found, of_all = _with_own_loads(problem, [_whole(problem, n, 0.0) for n in recordings], scan, effects)
    same = len(found) == len(recordings) and all(are_alike(one, other) for one, other in combinations(found, 2))
    return None if same else of_all


def loads_of_whole(problem: Problem, recordings: Sequence[int], scan: Scan) -> Differing | None:
    """A load for each of these recordings, beside no effect; None where some have none."""
    found, of_all = _with_own_loads(problem, [_whole(problem, n, 0.0) for n in recordings], scan, ())
    return of_all if len(found) == len(recordings) else None


def with_origins_of(problem: Problem, other: Problem) -> Problem:
    """The problem with each held-out recording as a part of the fitted one that it is in another problem."""
    return _as_parts(problem, {p.recording: p.origin for p in other.holdout})


def _whole(problem: Problem, recording: int, gain: float) -> EventInterval:
    pieces = _fitted(problem, recording)
    return EventInterval(recording, False, float(pieces[0].time[0]), float(pieces[-1].time[-1]), gain)


def _with_own_loads(
    problem: Problem, whole: Sequence[EventInterval], scan: Scan, effects: Sequence[NamedEffect]
) -> tuple[list[Transient], Differing | None]:
    """The loads of whole recordings, and what they explain; None where half of the held-out error or more is left."""
    if len({p.recording for p in problem.fit}) < 2 or not whole:
        return [], None
    beside = tuple(e for e in effects if effect_named(e.effect).of_motion_alone)
    if not may_have_load(problem, [s.recording for s in whole], beside, scan.power):
        return [], None
    scan = replace(scan, events=tuple(whole))
    parts = separate(problem, beside, np.sqrt(scan.power), scan)
    if len(_loads_of(parts)) < len(whole):  # where many recordings have a load, what is usual is not the noise
        scan = replace(scan, power=_left(problem, parts, scan))
        parts = separate(problem, parts.refit.effects, np.sqrt(scan.power), scan)
    found, beside = _loads_of(parts), parts.refit.effects
    loads = tuple(t.effect for t in found)
    problem = with_the_same_loads(problem, loads, scan, beside)
    error, before = (_error(problem, some, scan, beside) for some in (loads, ()))
    if not loads or error > FALLS * before:
        return found, None
    return found, Differing(problem, tuple(to_the_end(problem, e) for e in loads), scan)


def _loads_of(parts: Separated) -> list[Transient]:
    return [t for t in parts.transients if effect_named(t.effect.effect).is_body]


def _left(problem: Problem, parts: Separated, scan: Scan) -> np.ndarray:
    """Mean r² that is left of the fitted motion, never nothing and at most what is usual, shape (dof,) [N² m²]."""
    effects = (*parts.refit.effects, *(t.effect for t in parts.transients))
    series = residual_by_recording(problem, problem.fit, effects)
    power = sum(np.sum((s.residual * s.valid) ** 2, axis=0) for s in series)
    mean = power / np.maximum(1, sum(s.valid.sum(axis=0) for s in series))
    return np.clip(mean, (1e-9 * problem.scale) ** 2, np.maximum(scan.power, 1e-300))


def are_alike(one: Transient, other: Transient) -> bool:
    """|p − p'| ≤ √(h² + h'²) for mass and centre of two loads with 95 % intervals p ± h."""

    def apart(name: str) -> bool:
        pair = [(t.effect.values[name], np.ptp(t.intervals[name]) / 2.0) for t in (one, other)]
        return bool(abs(pair[0][0] - pair[1][0]) > np.hypot(pair[0][1], pair[1][1]))

    return not any(apart(name) for name in ("m", "cx", "cy", "cz"))


def with_the_same_loads(
    problem: Problem, loads: Sequence[NamedEffect], scan: Scan, beside: Sequence[NamedEffect] = ()
) -> Problem:
    """The problem with each held-out recording as a part of the fitted one whose load halves its squared error.

    Args:
        beside: effects that act in all recordings.
    """
    origins: dict[int, int | None] = {}
    for recording in sorted({p.recording for p in problem.holdout if p.origin is None}):
        alone = replace(problem, holdout=tuple(p for p in problem.holdout if p.recording == recording))
        tried = {e.recording: _error(_as_parts(alone, {recording: e.recording}), loads, scan, beside) for e in loads}
        best = min(tried, key=lambda origin: tried[origin], default=None)
        if best is not None and tried[best] < FALLS * _error(alone, (), scan, beside):
            origins[recording] = best
    return _as_parts(problem, origins)


def _as_parts(problem: Problem, origins: Mapping[int, int | None]) -> Problem:
    """The problem with held-out recordings as parts of fitted ones, by their numbers."""
    return replace(
        problem, holdout=tuple(replace(p, origin=origins.get(p.recording, p.origin)) for p in problem.holdout)
    )


def without_loads(problem: Problem, loads: Sequence[NamedEffect]) -> Problem:
    """The problem less the torque of the loads, fitted and held out."""
    fit, holdout = (tuple(_less(problem, p, loads) for p in part) for part in (problem.fit, problem.holdout))
    return replace(problem, fit=fit, holdout=holdout)


def lasting_loads(problem: Problem, transients: Sequence[Transient]) -> tuple[Transient, ...]:
    """The same loads until the last held-out sample of their recordings, whose ends are no estimates."""
    out = []
    for one in transients:
        effect = to_the_end(problem, one.effect)
        start, end = effect.interval or (0.0, 0.0)
        out.append(replace(one, effect=effect, intervals={**one.intervals, "t0": (start, start), "t1": (end, end)}))
    return tuple(out)


def to_the_end(problem: Problem, effect: NamedEffect) -> NamedEffect:
    """The effect from the first sample of its recording to the last, the held-out end included."""
    own = [*_fitted(problem, effect.recording), *(p for p in problem.holdout if p.origin == effect.recording)]
    return replace(effect, interval=(float(min(p.time[0] for p in own)), float(max(p.time[-1] for p in own))))


def _fitted(problem: Problem, recording: int | None) -> list[Segment]:
    return [p for p in problem.fit if p.recording == recording]


def _less(problem: Problem, piece: Segment, loads: Sequence[NamedEffect]) -> Segment:
    return replace(piece, tau=piece.tau - (torque_with(piece.motion(problem), loads) - piece.load))


def _error(problem: Problem, loads: Sequence[NamedEffect], scan: Scan, beside: Sequence[NamedEffect]) -> float:
    """Σ r² / σ² on held-out samples."""
    effects = [*beside, *(to_the_end(problem, e) for e in loads)]
    residuals = (problem.reduce(p, p.tau - torque_with(p.motion(problem), effects)) * p.counts for p in problem.holdout)
    return float(sum(np.sum(r**2 / scan.power) for r in residuals))
