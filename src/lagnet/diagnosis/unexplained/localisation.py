"""Σ_{t∈R} r² / Σ r²: share of a residual in regimes R of the motion, such as low speed or a range of positions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.recordings.sampling import median_step

LEAST_LIFT = 1.3  # residual power in a regime over that overall, below which the regime is not reported
MOST_REGIMES = 4
PARTS = 6  # ranges of position and intervals of time that are tried
AFTER_REVERSAL = 0.15  # [s] around a change of direction
ROUNDING = 1e-9  # of the recorded torque: a nominal torque below it is zero but for rounding
FEW = 20  # samples below which a regime is not considered


@dataclass(frozen=True)
class Regime:
    """A part of the motion in which the residual is larger than elsewhere.

    Args:
        regime: kind, as in the verdict's schema.
        rule: readable condition.
        share_of_residual, share_of_time: 0 to 1.
        lift: residual power inside over residual power overall.
    """

    regime: str
    rule: str
    share_of_residual: float
    share_of_time: float
    lift: float


Span = tuple[int, float, float]
"""Recording, start and end [s] of an interval."""


def locate(
    problem: Problem, residual: np.ndarray, joint: int, prismatic: bool, spans: Sequence[Span] = ()
) -> tuple[Regime, ...]:
    """The regimes of a joint where its residual concentrates, strongest first, and 'everywhere' where it does not.

    Args:
        residual: shape (n,), on the valid samples of the fitted segments [N m].
        spans: intervals that are tried beside those of equal length.
    """
    power = residual**2
    total = float(power.sum())
    if not total > 0:
        return ()
    found: list[Regime] = []
    for kind, rule, inside in _regimes(problem, joint, "m" if prismatic else "rad", spans):
        time = float(inside.mean())
        if np.count_nonzero(inside) >= FEW and time < 0.7:
            share = float(power[inside].sum() / total)
            found.append(Regime(kind, rule, share, time, share / time))
    best: dict[str, Regime] = {}
    for regime in sorted(found, key=lambda r: -r.lift * np.sqrt(r.share_of_residual)):
        if regime.lift > LEAST_LIFT and regime.regime not in best:
            best[regime.regime] = regime
    found_regimes = tuple(best.values())[:MOST_REGIMES]
    return found_regimes or (Regime("everywhere", "all samples", 1.0, 1.0, 1.0),)


def _joined(pieces: tuple[Segment, ...], name: str, joint: int) -> np.ndarray:
    return np.concatenate([getattr(p, name)[p.keep, joint] for p in pieces])


def _regimes(problem: Problem, joint: int, unit: str, spans: Sequence[Span]) -> Iterator[tuple[str, str, np.ndarray]]:
    q, v, a, load = (_joined(problem.fit, n, joint) for n in ("q", "v", "a", "load"))
    near = np.concatenate([near_reversal(p, joint)[p.keep] for p in problem.fit])
    yield "velocity_reversal", f"within {AFTER_REVERSAL:g} s of a change of sign of v_{joint}", near
    speed = np.abs(v)
    for quantile in (0.1, 0.25):
        limit = float(np.quantile(speed, quantile))
        yield "low_speed", f"|v_{joint}| < {limit:.3g} {unit}/s", speed < limit
    for quantile in (0.75, 0.9):
        limit = float(np.quantile(speed, quantile))
        yield "high_speed", f"|v_{joint}| > {limit:.3g} {unit}/s", speed > limit
    yield "positive_direction", f"v_{joint} > 0", v > problem.slow[joint]
    yield "negative_direction", f"v_{joint} < 0", v < -problem.slow[joint]
    limit = float(np.quantile(np.abs(a), 0.8))
    yield "high_acceleration", f"|a_{joint}| > {limit:.3g} {unit}/s²", np.abs(a) > limit
    heavy, newton = float(np.quantile(np.abs(load), 0.8)), "N" if unit == "m" else "N m"
    if heavy > ROUNDING * problem.scale[joint]:
        yield "high_load", f"|nominal torque_{joint}| > {heavy:.3g} {newton}", np.abs(load) > heavy
    edges = np.linspace(q.min(), q.max(), PARTS + 1)
    for low, high in pairwise(edges):
        yield "position", f"{low:.3g} ≤ q_{joint} < {high:.3g} {unit}", (q >= low) & (q < high)
    yield from _times(problem, spans)


def _times(problem: Problem, spans: Sequence[Span]) -> Iterator[tuple[str, str, np.ndarray]]:
    recording = np.concatenate([np.full(p.keep.size, p.recording) for p in problem.fit])
    time = np.concatenate([p.time[p.keep] for p in problem.fit])
    parts = list(spans)
    for index in np.unique(recording):
        own = recording == index
        edges = np.linspace(time[own].min(), time[own].max() + 1e-9, PARTS + 1)
        parts += [(int(index), float(low), float(high)) for low, high in pairwise(edges)]
    for index, low, high in parts:
        rule = f"{low:.3g} s ≤ t < {high:.3g} s of recording {index + 1}"
        yield "time_interval", rule, (recording == index) & (time >= low) & (time < high)


def near_reversal(piece: Segment, joint: int) -> np.ndarray:
    """Samples around a change of direction of a joint, shape (n,)."""
    v = piece.v[:, joint]
    turns = np.flatnonzero(np.diff(np.sign(v)) != 0)
    marks = np.zeros(v.size)
    marks[turns] = 1.0
    width = max(1, round(AFTER_REVERSAL / max(1e-9, median_step(piece.time))))
    return np.convolve(marks, np.ones(2 * width + 1), mode="same") > 0
