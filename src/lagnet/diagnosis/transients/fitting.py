"""p̂, t̂₀, t̂₁ of each transient law on an event interval, and the odds between the laws."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.problem.intervals import EventInterval
from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.problem.residuals import RecordingResidual
from lagnet.diagnosis.transients.detection import Scan
from lagnet.diagnosis.transients.surroundings import around, inside, solve
from lagnet.effects.effect import Values
from lagnet.effects.external.contact_force import FORCE, POINT, ContactForce
from lagnet.effects.inertia.payload import INERTIA, Payload
from lagnet.models.corrected.named_effects import NamedEffect

BEYOND = 2.0  # samples by which an edge may lie outside of its recording
RADIUS = 0.03  # [m] of gyration from which the inertia of a load is fitted


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
        persistent: effects that act always.
    """
    near = around(problem, persistent, event)
    sigma = np.sqrt(scan.power)
    series = near.residual()
    fits = [near.fitted(start, sigma) for start in _starts(near.problem, series, event, scan.power)]
    penalties = [problem.limits.penalty(f.correlations.shape[0] - 2, 0) for f in fits]
    costs = [
        near.misfit(f.effects[0], sigma) / scan.inflation + penalty for f, penalty in zip(fits, penalties, strict=True)
    ]
    order = np.argsort(costs)
    best = fits[order[0]].effects[0]
    rival = fits[order[1]].effects[0].effect if len(fits) > 1 else None
    odds = float((costs[order[1]] - costs[order[0]]) / np.log(10.0)) if len(fits) > 1 else None
    return EventFit(
        best,
        odds,
        rival,
        *_residual_power(series, near.residual(best), best, scan),
        *near.parts_unseen(best),
        problem.limits.tie_odds,
    )


def _starts(near: Problem, series: RecordingResidual, event: EventInterval, power: np.ndarray) -> list[NamedEffect]:
    """A contact, and a load where the force points as gravity would have it."""
    rows = inside(series, event.start, event.end)
    law, motion = ContactForce(), _cut(series, rows).motion
    weight = (series.valid[rows] / power)[:, :, None]
    columns = law.relaxed(motion)
    contact = law.nearest(solve(columns, columns * weight, series.residual[rows]))
    interval = _whole(near, series, event)
    out = [NamedEffect(law.name, None, contact, interval, event.recording)]
    load = _load_like(contact, np.asarray(motion.bodies.gravity, dtype=float))
    return [*out, NamedEffect(Payload.name, None, load, interval, event.recording)] if load else out


def _whole(near: Problem, series: RecordingResidual, event: EventInterval) -> tuple[float, float]:
    """The interval of an event; beyond the end of the recording where the valid samples end inside it.

    An edge on the very last sample would have a derivative of nothing but rounding, and go anywhere.
    """
    beyond = BEYOND / near.rate
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


def _cut(series: RecordingResidual, rows: np.ndarray) -> RecordingResidual:
    m = series.motion
    motion = replace(m, time=m.time[rows], q=m.q[rows], v=m.v[rows], a=m.a[rows], load=m.load[rows], cache={})
    return RecordingResidual(motion, series.residual[rows], series.valid[rows], series.index)


def _residual_power(
    series: RecordingResidual, after: RecordingResidual, effect: NamedEffect, scan: Scan
) -> tuple[float, float, np.ndarray]:
    """E(law)/E(0) inside the event, E(law) over the usual power, and the gain at each joint [nats].

    With the usual power as the noise, a joint that is usually almost still would gain more than all others together.
    """
    start, end = effect.interval or (0.0, 0.0)
    rows = inside(series, start, end)
    counts = series.valid[rows].sum(axis=0)
    noise = max(1.0, float(counts.sum()))
    before, after_power = (
        np.sum((s.residual[rows] * s.valid[rows]) ** 2, axis=0) / scan.power for s in (series, after)
    )
    share = float(np.clip((after_power.sum() - noise) / max(before.sum() - noise, 1e-300), 0.0, 1.0))
    gains = 0.5 * counts * np.log(np.maximum(before, 1e-300) / np.maximum(after_power, 1e-300)) / scan.inflation
    return share, float(after_power.sum()) / noise, gains
