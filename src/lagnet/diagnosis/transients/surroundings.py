"""The segments around an event: laws fitted there beside what acts always, and what their parts tell of one another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.estimation.gauss_newton import start_gauss_newton
from lagnet.diagnosis.estimation.refit import Refit, refit
from lagnet.diagnosis.problem.intervals import SMEAR, EventInterval
from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.diagnosis.problem.residuals import RecordingResidual, residual_by_recording, with_known_state
from lagnet.diagnosis.regression.normal_equations import ridge_solve
from lagnet.effects.external.contact_force import FORCE, POINT, ContactForce
from lagnet.models.corrected.named_effects import NamedEffect

AROUND = 3.0  # [s] before and after an event on which its edges are fitted
BLOCKS = 4  # parts of an event that predict one another
RIDGE = 1e-6
STILL = 1e-9  # of the largest joint torque: the scale of a joint that has none


@dataclass(frozen=True, eq=False)
class SurroundingSegments:
    """The segments around an event, and what acts always.

    A load on a tilted base, or under a torque that saturates, is no sum of both: a law is fitted beside what persists.
    """

    problem: Problem
    persistent: tuple[NamedEffect, ...]

    def residual(self, *laws: NamedEffect) -> RecordingResidual:
        """r with the laws beside what acts always."""
        (one,) = residual_by_recording(self.problem, self.problem.fit, (*self.persistent, *laws))
        return one

    def fitted(self, law: NamedEffect, sigma: np.ndarray) -> Refit:
        """The law refitted beside what acts always, which stays."""
        return refit(self.problem, (law,), sigma, beside=self.persistent)

    def parts_unseen(self, law: NamedEffect) -> tuple[float, float]:
        """nMSE of the parts of an event, each predicted from the others, without the law and with it.

        In a step from the fit only what the torque is linear in changes, the force or the mass and its first moment.
        """
        scale = np.maximum(self.problem.scale, STILL * np.max(self.problem.scale))
        work, x = start_gauss_newton(self.problem, (law,), scale, beside=self.persistent)
        free = np.arange(x.size) < (len(FORCE) if law.effect == ContactForce.name else 1 + len(POINT))
        left, slopes = np.concatenate(work.residuals(x)), np.concatenate(work.jacobian(x, free))
        (without,) = residual_by_recording(self.problem, work.pieces, self.persistent)
        rows = _well_inside(without, law, SMEAR / self.problem.bandwidth)
        unseen = predicted_from_the_others(left[rows], slopes[rows])
        count = np.maximum(without.valid[rows].sum(axis=0), 1)
        before = without.residual[rows] * without.valid[rows] / scale
        nothing, with_it = (np.sum(r**2, axis=0) / count for r in (before, unseen))
        moved = nothing > self.problem.limits.least_ratio * with_it
        at = np.flatnonzero(moved) if moved.any() else np.arange(len(nothing))
        return float(np.mean(nothing[at])), float(np.mean(with_it[at]))

    def misfit(self, law: NamedEffect, sigma: np.ndarray) -> float:
        """Half the weighted squared error [nats]."""
        series = self.residual(law)
        return 0.5 * float(np.sum((series.residual * series.valid / sigma) ** 2))


def around(problem: Problem, persistent: Sequence[NamedEffect], event: EventInterval) -> SurroundingSegments:
    """What lies within a few seconds of an event."""
    low, high = event.start - AROUND, event.end + AROUND
    pieces = [p for p in problem.fit if p.recording == event.recording and p.time[0] < high and low < p.time[-1]]
    near = (_between(with_known_state(problem, p, persistent), low, high) for p in pieces)
    return SurroundingSegments(replace(problem, fit=tuple(near)), tuple(persistent))


def _between(piece: Segment, low: float, high: float) -> Segment:
    inside = (piece.time[piece.keep] >= low) & (piece.time[piece.keep] <= high)
    return replace(piece, counts=piece.counts & inside[:, None])


def _well_inside(series: RecordingResidual, effect: NamedEffect, slack: float) -> np.ndarray:
    """Samples of an event less those near its edges that the filter blurs, where enough are left."""
    start, end = effect.interval or (0.0, 0.0)
    inner = inside(series, start + slack, end - slack)
    return inner if inner.size > 2 * BLOCKS else inside(series, start, end)


def predicted_from_the_others(residual: np.ndarray, slopes: np.ndarray) -> np.ndarray:
    """What each part leaves after one step of Gauss–Newton on all other parts, shape (n, dof).

    Args:
        residual: shape (n, dof), of the fit.
        slopes: shape (n, dof, k), its derivatives.
    """
    out = np.zeros_like(residual)
    for rows in np.array_split(np.arange(len(residual)), BLOCKS):
        others = np.setdiff1d(np.arange(len(residual)), rows)
        out[rows] = residual[rows] - slopes[rows] @ solve(slopes[others], slopes[others], residual[others])
    return out


def inside(series: RecordingResidual, start: float, end: float) -> np.ndarray:
    """Numbers of the samples from start to end."""
    return np.flatnonzero((series.time >= start) & (series.time <= end))


def solve(columns: np.ndarray, weighted: np.ndarray, residual: np.ndarray) -> np.ndarray:
    """Coefficients of columns (n, dof, k), weighted in the normal equations, shape (k,)."""
    gram = np.einsum("njk,njl->kl", weighted, columns)
    return ridge_solve(gram, np.einsum("njk,nj->k", weighted, residual), RIDGE)
