"""What acts during a spell: each law that may last for a while is fitted to it, edges included, against the others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.evidence_of import HARMLESS
from lagnet.diagnosis.problem import Piece, Problem
from lagnet.diagnosis.refit import Refit, refit
from lagnet.diagnosis.rivals import TIE
from lagnet.diagnosis.search import price
from lagnet.diagnosis.spells import SMEAR, Scan, Spell
from lagnet.diagnosis.strands import Strand, strands_of
from lagnet.effects.effect import Values
from lagnet.effects.external.contact_force import FORCE, POINT, ContactForce
from lagnet.effects.inertia.payload import INERTIA, Payload
from lagnet.models.corrected import NamedEffect, torque_with

AROUND = 3.0  # [s] before and after a spell that its edges are fitted on
BLOCKS = 4  # parts of a spell that predict one another
RADIUS = 0.03  # [m] of gyration from which the inertia of a load is fitted
RIDGE = 1e-6


@dataclass(frozen=True, eq=False)
class SpellFit:
    """One law fitted to a spell.

    Args:
        effect: with its interval and recording.
        odds: log10 odds over the rival; None where there is none.
        rival: the other law.
        left: share of the power inside beyond noise that the law leaves, 0 to 1.
        over_usual: power that the law leaves inside, over what is usually left in the recordings.
        gains: shape (dof,), log likelihood that the law gains inside, joint by joint [nats].
        without, with_it: nMSE inside the spell, averaged over the joints that it moves, on parts that were not fitted.
    """

    effect: NamedEffect
    odds: float | None
    rival: str | None
    left: float
    over_usual: float
    gains: np.ndarray
    without: float
    with_it: float

    @property
    def strongest(self) -> int:
        """The joint at which it gains most."""
        return int(np.argmax(self.gains))

    @property
    def elsewhere(self) -> float:
        """What it gains at all other joints together [nats]."""
        return float(np.sum(self.gains) - np.max(self.gains))

    @property
    def tied(self) -> tuple[str, ...]:
        """Names that the spell cannot tell from it."""
        return (self.rival,) if self.rival and self.odds is not None and self.odds < TIE else ()


def fit_spell(problem: Problem, lasting: Sequence[NamedEffect], spell: Spell, scan: Scan) -> SpellFit:
    """Fits a contact and a load to a spell of a fitted recording and takes the likelier.

    Args:
        problem: with the samples of the spell.
        lasting: effects that act always.
    """
    near = _near(problem, lasting, spell)
    sigma = np.sqrt(scan.power)
    fits = [refit(near, (start,), sigma) for start in _starts(near, spell, scan.power)]
    costs = [_misfit(near, f, sigma) / scan.inflation + price(f.correlations.shape[0] - 2, 0) for f in fits]
    order = np.argsort(costs)
    best = fits[order[0]].effects[0]
    rival = fits[order[1]].effects[0].effect if len(fits) > 1 else None
    odds = float((costs[order[1]] - costs[order[0]]) / np.log(10.0)) if len(fits) > 1 else None
    (strand,) = strands_of(near, near.fit, ())
    return SpellFit(best, odds, rival, *_left(near, strand, best, scan), *_unseen(near, strand, best))


def _near(problem: Problem, lasting: Sequence[NamedEffect], spell: Spell) -> Problem:
    """The pieces around a spell with the torque of lasting effects taken off."""
    low, high = spell.start - AROUND, spell.end + AROUND
    pieces = [p for p in problem.fit if p.recording == spell.recording and p.time[0] < high and low < p.time[-1]]
    return replace(problem, fit=tuple(_cleared(problem, p, lasting, low, high) for p in pieces))


def _cleared(problem: Problem, piece: Piece, lasting: Sequence[NamedEffect], low: float, high: float) -> Piece:
    lasting_torque = torque_with(piece.motion(problem), lasting) - piece.load
    inside = (piece.time[piece.keep] >= low) & (piece.time[piece.keep] <= high)
    return replace(piece, tau=piece.tau - lasting_torque, counts=piece.counts & inside[:, None])


def _starts(near: Problem, spell: Spell, power: np.ndarray) -> list[NamedEffect]:
    """A contact, and a load where the force points as gravity would have it."""
    (strand,) = strands_of(near, near.fit, ())
    rows = _inside(strand, spell.start, spell.end)
    law, motion = ContactForce(), _cut(strand, rows).motion
    weight = (strand.counts[rows] / power)[:, :, None]
    columns = law.relaxed(motion)
    contact = law.nearest(_solve(columns, columns * weight, strand.rest[rows]))
    interval = _whole(near, strand, spell)
    out = [NamedEffect(law.name, None, contact, interval, spell.recording)]
    load = _load_like(contact, np.asarray(near.nominal.gravity, dtype=float))
    return [*out, NamedEffect(Payload.name, None, load, interval, spell.recording)] if load else out


def _whole(near: Problem, strand: Strand, spell: Spell) -> tuple[float, float]:
    """The interval of a spell; to the end of the recording where the samples that are evidence end in it."""
    start = near.fit[0].time[0] if spell.start <= strand.time[0] else spell.start
    end = near.fit[-1].time[-1] if spell.end >= strand.time[-1] else spell.end
    return float(start), float(end)


def _load_like(contact: Values, gravity: np.ndarray) -> Values | None:
    """A load whose weight is the contact force, if that points against gravity."""
    force = np.array([contact[n] for n in FORCE])
    mass = -float(force @ gravity) / float(gravity @ gravity)
    if not mass > 0.0:
        return None
    centre = {f"c{n[1]}": contact[n] for n in POINT}
    moments = {n: mass * RADIUS**2 if n[1] == n[2] else 0.0 for n in INERTIA}
    return {"m": mass, **centre, **moments}


def _solve(columns: np.ndarray, weighted: np.ndarray, rest: np.ndarray) -> np.ndarray:
    k = columns.shape[2]
    gram = np.einsum("njk,njl->kl", weighted, columns)
    scale = 1.0 / np.sqrt(np.maximum(np.diag(gram), 1e-300))
    scaled = gram * scale[:, None] * scale[None, :] + RIDGE * np.eye(k)
    return np.linalg.solve(scaled, np.einsum("njk,nj->k", weighted, rest) * scale) * scale


def _misfit(near: Problem, fitted: Refit, sigma: np.ndarray) -> float:
    """Half the weighted squared error with the fitted effects [nats]."""
    (strand,) = strands_of(near, near.fit, fitted.effects)
    return 0.5 * float(np.sum((strand.rest * strand.counts / sigma) ** 2))


def _inside(strand: Strand, start: float, end: float) -> np.ndarray:
    return np.flatnonzero((strand.time >= start) & (strand.time <= end))


def _cut(strand: Strand, rows: np.ndarray) -> Strand:
    m = strand.motion
    motion = replace(m, time=m.time[rows], q=m.q[rows], v=m.v[rows], a=m.a[rows], load=m.load[rows], cache={})
    return Strand(motion, strand.rest[rows], strand.counts[rows], strand.index)


def _left(near: Problem, strand: Strand, effect: NamedEffect, scan: Scan) -> tuple[float, float, np.ndarray]:
    """What a law leaves inside, as a share of what was there, and over what is usual; what it gains at each joint."""
    (after,) = strands_of(near, near.fit, (effect,))
    start, end = effect.interval or (0.0, 0.0)
    rows = _inside(strand, start, end)
    noise = max(1.0, float(strand.counts[rows].sum()))
    before, rest = (np.sum((s.rest[rows] * s.counts[rows]) ** 2, axis=0) / scan.power for s in (strand, after))
    share = float(np.clip((rest.sum() - noise) / max(before.sum() - noise, 1e-300), 0.0, 1.0))
    return share, float(rest.sum()) / noise, 0.5 * (before - rest) / scan.inflation


def _unseen(near: Problem, strand: Strand, effect: NamedEffect) -> tuple[float, float]:
    """Errors of the parts of a spell, each predicted from the others, as shares of the torque's variance."""
    start, end = effect.interval or (0.0, 0.0)
    slack = SMEAR / near.bandwidth
    inner = _inside(strand, start + slack, end - slack)
    part = _cut(strand, inner if inner.size > 2 * BLOCKS else _inside(strand, start, end))
    columns, rest = _columns(effect, part)
    weight = part.counts / near.scale**2
    error = np.zeros_like(rest)
    for rows in np.array_split(np.arange(len(rest)), BLOCKS):
        others = np.setdiff1d(np.arange(len(rest)), rows)
        theta = _solve(columns[others], columns[others] * weight[others][:, :, None], rest[others])
        error[rows] = rest[rows] - columns[rows] @ theta
    count = np.maximum(part.counts.sum(axis=0), 1)
    without, with_it = (np.sum((x * part.counts) ** 2, axis=0) / count / near.scale**2 for x in (part.rest, error))
    moved = without > HARMLESS * with_it
    at = np.flatnonzero(moved) if moved.any() else np.arange(len(without))
    return float(np.mean(without[at])), float(np.mean(with_it[at]))


def _columns(effect: NamedEffect, part: Strand) -> tuple[np.ndarray, np.ndarray]:
    """Columns of the force, or of mass and first moment, with the rest of the law taken as fitted."""
    if effect.effect == ContactForce.name:
        return ContactForce().columns(part.motion, None, effect.values), part.rest
    law = Payload()
    columns = law.columns(part.motion, None, {})
    return columns[:, :, :4], part.rest - columns[:, :, 4:] @ law.coordinates(effect.values)[4:]
