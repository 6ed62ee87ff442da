"""p̂, t̂₀, t̂₁ of each transient law on an event interval, and the odds between the laws."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.estimation.refit import Refit, refit
from lagnet.diagnosis.problem.intervals import SMEAR, EventInterval
from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.diagnosis.problem.residuals import RecordingResidual, residual_by_recording
from lagnet.diagnosis.regression.normal_equations import ridge_solve
from lagnet.diagnosis.transients.detection import Scan
from lagnet.effects.effect import Values
from lagnet.effects.external.contact_force import FORCE, POINT, ContactForce
from lagnet.effects.inertia.payload import INERTIA, Payload
from lagnet.models.corrected.named_effects import NamedEffect, torque_with

AROUND = 3.0  # [s] before and after an event on which its edges are fitted
BLOCKS = 4  # parts of an event that predict one another
RADIUS = 0.03  # [m] of gyration from which the inertia of a load is fitted
RIDGE = 1e-6


@dataclass(frozen=True, eq=False)
class EventFit:
    """One law fitted to an event interval.

    Args:
        effect: with its interval and recording.
        odds: log10 odds over the rival; None where there is none.
        rival: the other law.
        residual_share: residual power inside beyond noise with the law over that without, 0 to 1.
        over_usual: residual power inside with the law over the usual residual power of the recordings.
        gains: shape (dof,), ½ n ln(E(0)/E(law)) inside, the likelihood gained with unknown noise, by joint [nats].
        without, with_it: nMSE inside the event, averaged over the joints that it moves, on parts that were not fitted.
        tie_odds: log10 odds below which the two are tied.
    """

    effect: NamedEffect
    odds: float | None
    rival: str | None
    residual_share: float
    over_usual: float
    gains: np.ndarray
    without: float
    with_it: float
    tie_odds: float

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
        """Names that the event does not distinguish from it."""
        return (self.rival,) if self.rival and self.odds is not None and self.odds < self.tie_odds else ()


def fit_event(problem: Problem, persistent: Sequence[NamedEffect], event: EventInterval, scan: Scan) -> EventFit:
    """argmax of the likelihood of a contact and of a load on an event interval of a fitted recording.

    Args:
        problem: with the samples of the event valid.
        lasting: effects that act always.
    """
    near = _near(problem, persistent, event)
    sigma = np.sqrt(scan.power)
    fits = [refit(near, (start,), sigma) for start in _starts(near, event, scan.power)]
    costs = [
        _misfit(near, f, sigma) / scan.inflation + problem.limits.penalty(f.correlations.shape[0] - 2, 0) for f in fits
    ]
    order = np.argsort(costs)
    best = fits[order[0]].effects[0]
    rival = fits[order[1]].effects[0].effect if len(fits) > 1 else None
    odds = float((costs[order[1]] - costs[order[0]]) / np.log(10.0)) if len(fits) > 1 else None
    (series,) = residual_by_recording(near, near.fit, ())
    return EventFit(
        best,
        odds,
        rival,
        *_residual_power(near, series, best, scan),
        *_unseen(near, series, best),
        near.limits.tie_odds,
    )


def _near(problem: Problem, persistent: Sequence[NamedEffect], event: EventInterval) -> Problem:
    """The segments around an event after the torque of persistent effects is subtracted."""
    low, high = event.start - AROUND, event.end + AROUND
    pieces = [p for p in problem.fit if p.recording == event.recording and p.time[0] < high and low < p.time[-1]]
    return replace(problem, fit=tuple(_cleared(problem, p, persistent, low, high) for p in pieces))


def _cleared(problem: Problem, piece: Segment, persistent: Sequence[NamedEffect], low: float, high: float) -> Segment:
    lasting_torque = torque_with(piece.motion(problem), persistent) - piece.load
    inside = (piece.time[piece.keep] >= low) & (piece.time[piece.keep] <= high)
    return replace(piece, tau=piece.tau - lasting_torque, counts=piece.counts & inside[:, None])


def _starts(near: Problem, event: EventInterval, power: np.ndarray) -> list[NamedEffect]:
    """A contact, and a load where the force points as gravity would have it."""
    (series,) = residual_by_recording(near, near.fit, ())
    rows = _inside(series, event.start, event.end)
    law, motion = ContactForce(), _cut(series, rows).motion
    weight = (series.valid[rows] / power)[:, :, None]
    columns = law.relaxed(motion)
    contact = law.nearest(_solve(columns, columns * weight, series.residual[rows]))
    interval = _whole(near, series, event)
    out = [NamedEffect(law.name, None, contact, interval, event.recording)]
    load = _load_like(contact, np.asarray(motion.bodies.gravity, dtype=float))
    return [*out, NamedEffect(Payload.name, None, load, interval, event.recording)] if load else out


def _whole(near: Problem, series: RecordingResidual, event: EventInterval) -> tuple[float, float]:
    """The interval of an event; beyond the end of the recording where the valid samples end inside it.

    An edge on the very last sample would have a derivative of nothing but rounding, and go anywhere.
    """
    beyond = 2.0 / near.rate
    start = near.fit[0].time[0] - beyond if event.start <= series.time[0] else event.start
    end = near.fit[-1].time[-1] + beyond if event.end >= series.time[-1] else event.end
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


def _solve(columns: np.ndarray, weighted: np.ndarray, residual: np.ndarray) -> np.ndarray:
    gram = np.einsum("njk,njl->kl", weighted, columns)
    return ridge_solve(gram, np.einsum("njk,nj->k", weighted, residual), RIDGE)


def _misfit(near: Problem, fitted: Refit, sigma: np.ndarray) -> float:
    """Half the weighted squared error with the fitted effects [nats]."""
    (series,) = residual_by_recording(near, near.fit, fitted.effects)
    return 0.5 * float(np.sum((series.residual * series.valid / sigma) ** 2))


def _inside(series: RecordingResidual, start: float, end: float) -> np.ndarray:
    return np.flatnonzero((series.time >= start) & (series.time <= end))


def _cut(series: RecordingResidual, rows: np.ndarray) -> RecordingResidual:
    m = series.motion
    motion = replace(m, time=m.time[rows], q=m.q[rows], v=m.v[rows], a=m.a[rows], load=m.load[rows], cache={})
    return RecordingResidual(motion, series.residual[rows], series.valid[rows], series.index)


def _residual_power(
    near: Problem, series: RecordingResidual, effect: NamedEffect, scan: Scan
) -> tuple[float, float, np.ndarray]:
    """E(law)/E(0) inside the event, E(law) over the usual power, and the gain at each joint [nats].

    With the usual power as the noise, a joint that is usually almost still would gain more than all others together.
    """
    (after,) = residual_by_recording(near, near.fit, (effect,))
    start, end = effect.interval or (0.0, 0.0)
    rows = _inside(series, start, end)
    counts = series.valid[rows].sum(axis=0)
    noise = max(1.0, float(counts.sum()))
    before, after_power = (
        np.sum((s.residual[rows] * s.valid[rows]) ** 2, axis=0) / scan.power for s in (series, after)
    )
    share = float(np.clip((after_power.sum() - noise) / max(before.sum() - noise, 1e-300), 0.0, 1.0))
    gains = 0.5 * counts * np.log(np.maximum(before, 1e-300) / np.maximum(after_power, 1e-300)) / scan.inflation
    return share, float(after_power.sum()) / noise, gains


def _unseen(near: Problem, series: RecordingResidual, effect: NamedEffect) -> tuple[float, float]:
    """nMSE of the parts of an event, each predicted from the others."""
    start, end = effect.interval or (0.0, 0.0)
    slack = SMEAR / near.bandwidth
    inner = _inside(series, start + slack, end - slack)
    part = _cut(series, inner if inner.size > 2 * BLOCKS else _inside(series, start, end))
    columns, residual = _columns(effect, part)
    weight = part.valid / near.scale**2
    error = np.zeros_like(residual)
    for rows in np.array_split(np.arange(len(residual)), BLOCKS):
        others = np.setdiff1d(np.arange(len(residual)), rows)
        theta = _solve(columns[others], columns[others] * weight[others][:, :, None], residual[others])
        error[rows] = residual[rows] - columns[rows] @ theta
    count = np.maximum(part.valid.sum(axis=0), 1)
    without, with_it = (np.sum((x * part.valid) ** 2, axis=0) / count / near.scale**2 for x in (part.residual, error))
    moved = without > near.limits.least_ratio * with_it
    at = np.flatnonzero(moved) if moved.any() else np.arange(len(without))
    return float(np.mean(without[at])), float(np.mean(with_it[at]))


def _columns(effect: NamedEffect, part: RecordingResidual) -> tuple[np.ndarray, np.ndarray]:
    """Columns of the force, or of mass and first moment, with all other parameters of the law as fitted."""
    if effect.effect == ContactForce.name:
        return ContactForce().columns(part.motion, None, effect.values), part.residual
    law = Payload()
    columns = law.columns(part.motion, None, {})
    return columns[:, :, :4], part.residual - columns[:, :, 4:] @ law.coordinates(effect.values)[4:]
