"""Event intervals [t₀, t₁]: where J(q, p)ᵀF explains a residual that is absent from all other recorded motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.problem.intervals import EventInterval
from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.problem.residuals import RecordingResidual, residual_by_recording
from lagnet.diagnosis.transients.scan_statistic import Running, run_up, windows
from lagnet.effects.external.contact_force import ContactForce
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.types import is_robot_model

SHORTEST = 0.6  # [s] that an event must last to be distinguished from a burst of disturbance
BLOCK = 1.0  # [s] over which the usual power of the residual is measured
LEAST = 100.0  # nats that an event must gain, divided by the inflation from correlation in time
STANDS_OUT = 4.0  # times the gain of the next best interval: a misspecified persistent law comes in bursts, too
LEAST_SHARE = 0.5  # of the power inside that the columns must explain
TRIED = 8  # intervals whose edges are refined
MOST_SAMPLES = 40_000  # that are scanned: of longer recordings every second, third ... sample, which bounds the memory
FEW = 8  # valid samples of a joint, below which a block is not used


@dataclass(frozen=True, eq=False)
class Scan:
    """Event intervals, with the scales of the scan statistic.

    Args:
        events: strongest first.
        power: shape (dof,), usual mean square residual outside of events [N² m²].
        inflation: how much more a short interval gains by chance than white noise would let it.
    """

    events: tuple[EventInterval, ...]
    power: np.ndarray
    inflation: float


def detect_events(
    problem: Problem, effects: Sequence[NamedEffect], noise: np.ndarray, stands_out: float = STANDS_OUT
) -> Scan:
    """argmax over [t₀, t₁] of the log likelihood gained by a force on the last link, on the residual of all recordings.

    Args:
        noise: shape (dof,), noise floor [N m].
        stands_out: factor by which the gain of an interval must exceed that of the next best one.
    """
    fitted, held = (residual_by_recording(problem, pieces, effects) for pieces in (problem.fit, problem.holdout))
    step = max(1, -(-sum(len(s.time) for s in (*fitted, *held)) // MOST_SAMPLES))
    all_series = [(s.thinned(step), is_held) for part, is_held in ((fitted, False), (held, True)) for s in part]
    power = np.maximum(_usual_power([s for s, _ in all_series]), np.maximum(noise, 1e-9 * problem.scale) ** 2)
    if not is_robot_model(problem.nominal):
        return Scan((), power, 1.0)
    law = ContactForce()
    sums = [run_up(law.relaxed(s.motion), s.residual * s.valid, s.valid / power) for s, _ in all_series]
    shortest = max(FEW, round(SHORTEST * _rate([s for s, _ in all_series])))
    looked = _closest_looks(sums, shortest, stands_out)
    events = [_event(all_series[n], start, stop, gain) for n, start, stop, gain in looked.best]
    return Scan(tuple(events), power, looked.inflation)


def _event(series: tuple[RecordingResidual, bool], start: int, stop: int, gain: float) -> EventInterval:
    (one, held_out), time = series, series[0].time
    return EventInterval(one.index, held_out, float(time[start]), float(time[stop - 1]), gain)


def _rate(all_series: Sequence[RecordingResidual]) -> float:
    steps = np.concatenate([np.diff(s.time) for s in all_series])
    return 1.0 / max(float(np.median(steps)), 1e-9) if steps.size else 1.0


def _usual_power(all_series: Sequence[RecordingResidual]) -> np.ndarray:
    """median over blocks of mean r², shape (dof,) [N² m²]: events are rare, so that the median is free of them."""
    blocks = []
    length = max(FEW, round(BLOCK * _rate(all_series)))
    for s in all_series:
        for rows in np.array_split(np.arange(len(s.time)), max(1, len(s.time) // length)):
            count = s.valid[rows].sum(axis=0)
            mean = np.sum((s.residual[rows] * s.valid[rows]) ** 2, axis=0) / np.maximum(count, 1)
            blocks.append(np.where(count >= FEW, mean, np.nan))
    table = np.array(blocks)
    known = ~np.isnan(table).all(axis=0)
    out = np.zeros(table.shape[1])
    out[known] = np.nanmedian(table[:, known], axis=0)
    return out


@dataclass(frozen=True, eq=False)
class _Looks:
    """Intervals (series, start, stop, gain) that exceed all others, and the inflation of chance gains."""

    best: tuple[tuple[int, int, int, float], ...]
    inflation: float


def _closest_looks(sums: Sequence[Running], shortest: int, stands_out: float) -> _Looks:
    """Tries windows of all lengths in all recordings, then moves the edges of the best ones."""
    tables = []
    for n, running in enumerate(sums):
        starts, stops = windows(len(running.power) - 1, shortest, len(running.power) - 1)
        if starts.size:
            tables.append(np.column_stack([np.full(starts.size, n), starts, stops, running.gains(starts, stops)]))
    if not tables:
        return _Looks((), 1.0)
    table = np.concatenate(tables)
    by_chance = 0.5 * sums[0].moment.shape[1]
    lengths = table[:, 2] - table[:, 1]
    inflation = max(1.0, float(np.median(table[lengths == shortest, 3])) / by_chance)
    usual = {n: float(np.median(table[lengths == n, 3])) for n in np.unique(lengths)}
    score = table[:, 3] / np.maximum([usual[n] for n in lengths], by_chance)
    found: list[tuple[int, int, int, float, float]] = []
    free = np.ones(len(table), dtype=bool)
    for i in np.argsort(-score):
        if len(found) == TRIED or not free[i]:
            continue
        n, start, stop = (int(x) for x in table[i, :3])
        start, stop = sums[n].best_edges(start, stop, shortest)
        gain = float(sums[n].gains(np.array([start]), np.array([stop]))[0])
        if not any(m == n and start < b and a < stop for m, a, b, _, _ in found):
            share = gain / max(0.5 * float(sums[n].power[stop] - sums[n].power[start]), 1e-300)
            found.append((n, start, stop, gain / inflation, share))
        free &= ~((table[:, 0] == n) & (table[:, 1] < stop) & (start < table[:, 2]))
    return _Looks(_standing_out(found, stands_out), inflation)


def _standing_out(
    found: Sequence[tuple[int, int, int, float, float]], factor: float
) -> tuple[tuple[int, int, int, float], ...]:
    """The strongest intervals down to the last whose gain is a multiple of the next; columns must explain each."""
    ranked = sorted(found, key=lambda f: -f[3])
    good = len(ranked) if len(ranked) < TRIED else TRIED - 1  # what comes after the last that was tried is not known
    good = next((k for k, f in enumerate(ranked) if f[4] < LEAST_SHARE and k < good), good)
    gains = [*(f[3] for f in ranked), 0.0]
    last = [k for k in range(1, good + 1) if gains[k - 1] > max(LEAST, factor * gains[k])]
    return tuple(f[:4] for f in ranked[: max(last)]) if last else ()
