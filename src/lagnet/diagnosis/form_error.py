"""Error of a law's form, which no scatter of blocks shows: a fit to a part of the motion finds other parameters.

Where the law is right, every part of the motion tells the same parameters up to noise. Where it is not quite, the
fit's parameters depend on how the motion is weighed, and how far they move is a standard error of its own. The test
for such a shift beyond noise is that of Hausman 1978 (Econometrica 46, 1251–1271); here the noise of the shift itself
comes from blocks of time, so that it needs no model of the noise.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.stats import t as student

from lagnet.diagnosis.motion_parts import parts_of
from lagnet.diagnosis.normal_equations import inverse, normal
from lagnet.diagnosis.problem import Piece, Problem
from lagnet.diagnosis.refit import Refit, Tangent, tangent_at
from lagnet.diagnosis.refit_work import blocks_of
from lagnet.diagnosis.spells import set_aside, too_much
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected import EDGES, NamedEffect
from lagnet.recordings.smoothing import low_pass

if TYPE_CHECKING:
    from lagnet.diagnosis.inquiry import Inquiry

Intervals = dict[str, tuple[float, float]]
Linear = tuple[np.ndarray, np.ndarray]  # residuals and derivatives of a piece
View = Callable[[int, np.ndarray, np.ndarray], Linear]  # of the piece's number, residuals and derivatives
LEAST_SAY = 0.25  # of the information on a parameter: a part that holds less of it tells nothing of the law
NARROWER = 0.5  # of the bandwidth


def with_form_error(inquiry: Inquiry) -> Inquiry:
    """The inquiry with intervals that know of the laws' own error; names and values stay."""
    effects = inquiry.effects
    if not effects:
        return inquiry
    masked = set_aside(inquiry.problem, inquiry.spells)
    problem = inquiry.problem if too_much(inquiry.problem, masked) else masked
    power = np.maximum(inquiry.found.fit.sse, inquiry.found.scales.noise_power)
    found = form_errors(problem, effects, np.sqrt(power / inquiry.bench.samples))
    errors = [_with_convention(*pair) for pair in zip(effects, found, strict=True)]
    old = (*inquiry.refit.intervals, *(p.intervals for p in inquiry.passing))
    wide = [widened(*pair) for pair in zip(old, errors, strict=True)]
    n = len(inquiry.refit.effects)
    refit = Refit(inquiry.refit.effects, tuple(wide[:n]), inquiry.refit.correlations)
    passing = tuple(replace(p, intervals=w) for p, w in zip(inquiry.passing, wide[n:], strict=True))
    return replace(inquiry, refit=refit, passing=passing)


def _with_convention(effect: NamedEffect, errors: dict[str, float]) -> dict[str, float]:
    """The errors, and what the meaning of a parameter leaves open whatever the recordings say."""
    open_by = effect_named(effect.effect).by_convention
    return {name: float(np.hypot(error, open_by.get(name, 0.0))) for name, error in errors.items()}


def form_errors(problem: Problem, effects: Sequence[NamedEffect], sigma: np.ndarray) -> list[dict[str, float]]:
    """By effect and parameter, by how much the error of the law's form widens the half-width of a 95 % interval.

    Args:
        problem: as it was fitted.
        effects: as they were fitted, all that were fitted together.
        sigma: shape (dof,), the joints' weights in the fit [N m].
    """
    names = [list(e.parameters()) for e in effects]
    of = np.repeat(np.arange(len(effects)), [len(n) for n in names])
    tangent = tangent_at(problem, effects, sigma)
    whole = _Influence(problem, tangent, lambda n, r, j: (r, j))
    quantile = float(student.ppf(0.975, max(2, whole.blocks.shape[0] - 1)))
    variance = np.zeros(of.size)
    for view, speaks_for in _views(problem, tangent, effects, sigma):
        part = _Influence(problem, tangent, view)
        moved = part.blocks - whole.blocks
        excess = moved.sum(axis=0) ** 2 - quantile**2 * np.sum(moved**2, axis=0)
        tells = (LEAST_SAY * part.variance <= whole.variance) & (part.variance > LEAST_SAY * whole.variance)
        variance = np.where(tells & speaks_for[of], np.maximum(variance, excess), variance)
    widths = quantile * np.sqrt(variance)
    return [
        {name: float(w) for name, w in zip(names[n], widths[of == n], strict=True) if name not in EDGES}
        for n in range(len(effects))
    ]


class _Influence:
    """What each block of time adds to the parameters in one step of a fit.

    `blocks` has shape (n_blocks, n_parameters); `variance`, shape (n_parameters,), is that of unit noise.
    """

    def __init__(self, problem: Problem, tangent: Tangent, view: View) -> None:
        own = tangent.slopes.shape[1]  # columns beyond are those of laws that stand for no parameter
        gram, scores = 0.0, []
        for n, blocks in enumerate(blocks_of(problem, tangent.pieces)):
            r, j = view(n, tangent.residuals[n], tangent.jacobians[n])
            gram = gram + normal([j], [r])[0]
            row = np.einsum("njk,nj->nk", j, r)
            scores.extend(row[rows].sum(axis=0) for rows in blocks)
        bread = inverse(np.asarray(gram))[:own]
        self.blocks = -np.array(scores) @ bread.T @ tangent.slopes.T
        self.variance = np.einsum("pk,kl,pl->p", tangent.slopes, bread[:, :own], tangent.slopes)


def _views(
    problem: Problem, tangent: Tangent, effects: Sequence[NamedEffect], sigma: np.ndarray
) -> Iterator[tuple[View, np.ndarray]]:
    """Parts of the motion, the slower half of its frequencies, and the fit beside signals that come late.

    With each, shape (n_effects,), the effects whose law it may judge.
    """
    for part in parts_of(problem, tangent.pieces, effects):

        def some(n: int, r: np.ndarray, j: np.ndarray, rows: tuple[np.ndarray, ...] = part.rows) -> Linear:
            return r * rows[n], j * rows[n][..., None]

        yield some, part.speaks_for

    def slower(n: int, r: np.ndarray, j: np.ndarray) -> Linear:
        keep = tangent.pieces[n].keep
        return _slower(problem, keep, r), _slower(problem, keep, j)

    known_late = {e.joint for e in effects if e.effect == "time_delay"}
    punctual = [j for j in range(problem.n_dof) if j not in known_late]

    def beside_delay(n: int, r: np.ndarray, j: np.ndarray) -> Linear:
        return r, np.concatenate([j, _late(problem, tangent.pieces[n], sigma)[..., punctual]], axis=2)

    of_all = np.ones(len(effects), dtype=bool)
    yield slower, of_all
    yield beside_delay, of_all


def _slower(problem: Problem, keep: np.ndarray, x: np.ndarray) -> np.ndarray:
    rate = problem.rate / max(1, int(np.median(np.diff(keep))))
    return low_pass(x.reshape(x.shape[0], -1), rate, NARROWER * problem.bandwidth).reshape(x.shape)


def _late(problem: Problem, piece: Piece, sigma: np.ndarray) -> np.ndarray:
    """What a small delay of each joint's torque signal would change, shape (len(keep), dof, dof).

    Filters of drives delay by a millisecond, too little to be named, and lean on laws of speed.
    """
    smooth = low_pass(piece.tau, problem.rate, problem.bandwidth)
    rate = np.gradient(smooth, 1 / problem.rate, axis=0)[piece.keep]
    return (rate * piece.counts / sigma)[..., None] * np.eye(problem.n_dof)


def widened(intervals: Intervals, errors: dict[str, float]) -> Intervals:
    """Intervals with the half-widths that the error of the law's form adds."""
    out = {}
    for name, (low, high) in intervals.items():
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        half = float(np.hypot(half, errors.get(name, 0.0)))
        out[name] = (middle - half, middle + half)
    return out
