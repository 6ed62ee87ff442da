"""Intervals of a recording in which something acts that is absent from the rest of the recordings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.interval_scan import Running, run_up, windows
from lagnet.diagnosis.problem import Piece, Problem
from lagnet.diagnosis.strands import Strand, strands_of
from lagnet.effects.external.contact_force import ContactForce
from lagnet.models.corrected import NamedEffect

SHORTEST = 0.6  # [s] that a spell must last to be told from a burst of disturbance
BLOCK = 1.0  # [s] over which the usual power of what is left is measured
LEAST = 100.0  # nats that a spell must gain, over and above how the residual hangs together
STANDS_OUT = 4.0  # times the gain of the next best interval: lasting physics of the wrong form comes in bursts, too
LEAST_SHARE = 0.5  # of the power inside that the columns must explain
TRIED = 8  # intervals that are looked at closely
SMEAR = 1.5  # periods of the bandwidth by which the filter widens a spell
MOST = 0.75  # of the samples that may be set aside
MOST_SAMPLES = 40_000  # that are scanned: of longer recordings every second, third ... sample, which bounds the memory
FEW = 8  # samples of a joint below which a block says nothing


@dataclass(frozen=True)
class Spell:
    """An interval of one recording that no lasting effect explains, but a force or load on the last link does.

    Args:
        recording: index among the fitted recordings, or among those held out.
        held_out: which of the two.
        start, end: [s] on the recording's clock.
        gain: log likelihood over what an interval gains by chance [1].
    """

    recording: int
    held_out: bool
    start: float
    end: float
    gain: float

    def covers(self, other: Spell, slack: float) -> bool:
        """Whether another spell lies inside it."""
        same = (self.recording, self.held_out) == (other.recording, other.held_out)
        return same and self.start - slack <= other.start and other.end <= self.end + slack


@dataclass(frozen=True, eq=False)
class Scan:
    """What was found, and the scales it was found by.

    Args:
        spells: strongest first.
        power: shape (dof,), usual squared torque that is left outside of spells [N² m²].
        inflation: how much more a short interval gains by chance than white noise would let it.
    """

    spells: tuple[Spell, ...]
    power: np.ndarray
    inflation: float


def find_spells(
    problem: Problem, effects: Sequence[NamedEffect], noise: np.ndarray, stands_out: float = STANDS_OUT
) -> Scan:
    """Scans what lasting effects leave of all recordings.

    Args:
        noise: shape (dof,), noise floor [N m].
        stands_out: how far an interval must leave behind the next best one.
    """
    fitted, held = (strands_of(problem, pieces, effects) for pieces in (problem.fit, problem.holdout))
    step = max(1, -(-sum(len(s.time) for s in (*fitted, *held)) // MOST_SAMPLES))
    strands = [(s.thinned(step), is_held) for part, is_held in ((fitted, False), (held, True)) for s in part]
    power = np.maximum(_usual_power([s for s, _ in strands]), np.maximum(noise, 1e-9 * problem.scale) ** 2)
    if not hasattr(problem.nominal, "wrench_regressor"):
        return Scan((), power, 1.0)
    law = ContactForce()
    sums = [run_up(law.relaxed(s.motion), s.rest * s.counts, s.counts / power) for s, _ in strands]
    shortest = max(FEW, round(SHORTEST * _rate([s for s, _ in strands])))
    looked = _closest_looks(sums, shortest, stands_out)
    spells = [_spell(strands[n], start, stop, gain) for n, start, stop, gain in looked.best]
    return Scan(tuple(spells), power, looked.inflation)


def set_aside(problem: Problem, spells: Sequence[Spell]) -> Problem:
    """The problem without the samples of the spells, for everything that lasts."""
    slack = SMEAR / problem.bandwidth
    parts = {}
    for name, held_out in (("fit", False), ("holdout", True)):
        own = [s for s in spells if s.held_out == held_out]
        parts[name] = tuple(_without(p, own, slack) for p in getattr(problem, name))
    return replace(problem, **parts)


def too_much(problem: Problem, masked: Problem) -> bool:
    """Whether so much was set aside that the rest can no longer be called the usual state of the arm."""
    return any(
        sum(p.counts.sum() for p in getattr(masked, name)) < (1.0 - MOST) * sum(p.counts.sum() for p in pieces)
        for name, pieces in (("fit", problem.fit), ("holdout", problem.holdout))
    )


def _without(piece: Piece, spells: Sequence[Spell], slack: float) -> Piece:
    time = piece.time[piece.keep]
    out = piece.counts
    for s in spells:
        if s.recording == piece.recording:
            out = out & ~((time >= s.start - slack) & (time <= s.end + slack))[:, None]
    return piece if out is piece.counts else replace(piece, counts=out)


def _spell(strand: tuple[Strand, bool], start: int, stop: int, gain: float) -> Spell:
    (one, held_out), time = strand, strand[0].time
    return Spell(one.index, held_out, float(time[start]), float(time[stop - 1]), gain)


def _rate(strands: Sequence[Strand]) -> float:
    steps = np.concatenate([np.diff(s.time) for s in strands])
    return 1.0 / max(float(np.median(steps)), 1e-9) if steps.size else 1.0


def _usual_power(strands: Sequence[Strand]) -> np.ndarray:
    """Median over blocks of the mean square that is left, shape (dof,): spells are the exception."""
    blocks = []
    length = max(FEW, round(BLOCK * _rate(strands)))
    for s in strands:
        for rows in np.array_split(np.arange(len(s.time)), max(1, len(s.time) // length)):
            count = s.counts[rows].sum(axis=0)
            mean = np.sum((s.rest[rows] * s.counts[rows]) ** 2, axis=0) / np.maximum(count, 1)
            blocks.append(np.where(count >= FEW, mean, np.nan))
    table = np.array(blocks)
    known = ~np.isnan(table).all(axis=0)
    out = np.zeros(table.shape[1])
    out[known] = np.nanmedian(table[:, known], axis=0)
    return out


@dataclass(frozen=True, eq=False)
class _Looks:
    """Intervals (strand, start, stop, gain) that stand out from all others, and the inflation of chance gains."""

    best: tuple[tuple[int, int, int, float], ...]
    inflation: float


def _closest_looks(sums: Sequence[Running], shortest: int, stands_out: float) -> _Looks:
    """Tries windows of all lengths in all strands, then moves the edges of the best ones."""
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
    """The strongest intervals down to the last that leaves the next one far behind; columns must explain each."""
    ranked = sorted(found, key=lambda f: -f[3])
    good = len(ranked) if len(ranked) < TRIED else TRIED - 1  # what comes after the last that was tried is not known
    good = next((k for k, f in enumerate(ranked) if f[4] < LEAST_SHARE and k < good), good)
    gains = [*(f[3] for f in ranked), 0.0]
    last = [k for k in range(1, good + 1) if gains[k - 1] > max(LEAST, factor * gains[k])]
    return tuple(f[:4] for f in ranked[: max(last)]) if last else ()
