"""δp² = (Σ_b Δp_b)² − t² Σ_b Δp_b²: misspecification error, Δp_b the share of block b in p̂(subset) − p̂(all).

Where the law is right, every part of the motion gives the same parameters up to noise. Where it is not quite, the
fit's parameters depend on how the motion is weighted, and how far they move is a standard error of its own. The test
for such a shift beyond noise is that of Hausman 1978 (Econometrica 46, 1251–1271); here the noise of the shift itself
comes from blocks of time, so that it needs no model of the noise.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from scipy.stats import t as student

from lagnet.diagnosis.estimation.gauss_newton import blocks_of
from lagnet.diagnosis.estimation.intervals.data_subsets import parts_of
from lagnet.diagnosis.estimation.intervals.long_run import long_run_excess
from lagnet.diagnosis.estimation.refit import Tangent, tangent_at
from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.diagnosis.regression.normal_equations import inverse, normal
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import EDGES, NamedEffect
from lagnet.recordings.conditioning.smoothing import low_pass
from lagnet.recordings.sampling import median_step

Intervals = dict[str, tuple[float, float]]
Linear = tuple[np.ndarray, np.ndarray]  # residuals and derivatives of a piece
View = Callable[[int, np.ndarray, np.ndarray], Linear]  # of the piece's number, residuals and derivatives
LEAST_SAY = 0.25  # of the information on a parameter: a part that holds less of it is not compared
NARROWER = 0.5  # of the bandwidth


def with_convention(effect: NamedEffect, errors: dict[str, float]) -> dict[str, float]:
    """√(errors² + convention²): adds what the definition of a parameter leaves open, whatever the recordings are."""
    open_by = effect_named(effect.effect).by_convention
    return {name: float(np.hypot(error, open_by.get(name, 0.0))) for name, error in errors.items()}


def interval_errors(problem: Problem, effects: Sequence[NamedEffect], sigma: np.ndarray) -> list[dict[str, float]]:
    """By effect and parameter, √(δp² + h_L² − h²): what widens the half-width h of a 95 % interval.

    δp is the misspecification error, h_L the half-width from longer blocks (`long_run_excess`).

    Args:
        problem: as it was fitted.
        effects: as they were fitted, all that were fitted together.
        sigma: shape (dof,), the joints' weights in the fit [N m].
    """
    tangent = tangent_at(problem, effects, sigma)
    whole = Influence(problem, tangent, as_it_is)
    excess = long_run_excess(whole.blocks, whole.counts)
    return by_effect(effects, np.sqrt(_misspecification(problem, tangent, whole, effects, sigma) + excess))


def misspecification_errors(
    problem: Problem, effects: Sequence[NamedEffect], sigma: np.ndarray
) -> list[dict[str, float]]:
    """By effect and parameter, the misspecification error δp alone; arguments as of `interval_errors`."""
    tangent = tangent_at(problem, effects, sigma)
    whole = Influence(problem, tangent, as_it_is)
    return by_effect(effects, np.sqrt(_misspecification(problem, tangent, whole, effects, sigma)))


def _misspecification(
    problem: Problem, tangent: Tangent, whole: Influence, effects: Sequence[NamedEffect], sigma: np.ndarray
) -> np.ndarray:
    """t² times the excess variance of the shifts between parts of the motion and all of it, shape (n_parameters,)."""
    of = np.repeat(np.arange(len(effects)), [len(e.parameters()) for e in effects])
    quantile = whole.quantile
    variance = np.zeros(of.size)
    for view, speaks_for in _views(problem, tangent, effects, sigma):
        part = Influence(problem, tangent, view)
        moved = part.blocks - whole.blocks
        excess = moved.sum(axis=0) ** 2 - quantile**2 * np.sum(moved**2, axis=0)
        tells = (LEAST_SAY * part.variance <= whole.variance) & (part.variance > LEAST_SAY * whole.variance)
        variance = np.where(tells & speaks_for[of], np.maximum(variance, excess), variance)
    return quantile**2 * variance


def as_it_is(n: int, residuals: np.ndarray, jacobian: np.ndarray) -> Linear:
    """The view of a fit that changes nothing."""
    return residuals, jacobian


def by_effect(effects: Sequence[NamedEffect], widths: np.ndarray) -> list[dict[str, float]]:
    """A number for each parameter of all effects in order, by effect and name; edges of intervals have none."""
    names = [list(e.parameters()) for e in effects]
    ends = np.cumsum([len(n) for n in names])[:-1]
    return [
        {name: float(w) for name, w in zip(own, part, strict=True) if name not in EDGES}
        for own, part in zip(names, np.split(widths, ends), strict=True)
    ]


class Influence:
    """What each block of time adds to the parameters in one step of a fit.

    `blocks` has shape (n_blocks, n_parameters); `counts` are those of each segment; `variance`, shape
    (n_parameters,), is that of unit noise; `quantile` Student's for a 95 % interval from so many blocks.
    """

    def __init__(self, problem: Problem, tangent: Tangent, view: View) -> None:
        own = tangent.slopes.shape[1]  # columns beyond are those of laws that stand for no parameter
        gram, scores, self.counts = 0.0, [], []
        for n, blocks in enumerate(blocks_of(problem, tangent.pieces)):
            r, j = view(n, tangent.residuals[n], tangent.jacobians[n])
            gram = gram + normal([j], [r])[0]
            row = np.einsum("njk,nj->nk", j, r)
            scores.extend(row[rows].sum(axis=0) for rows in blocks)
            self.counts.append(len(blocks))
        bread = inverse(np.asarray(gram))[:own]
        self.blocks = -np.array(scores) @ bread.T @ tangent.slopes.T
        self.variance = np.einsum("pk,kl,pl->p", tangent.slopes, bread[:, :own], tangent.slopes)
        self.quantile = float(student.ppf(0.975, max(2, len(scores) - 1)))


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

    known_late = {e.joint for e in effects if effect_named(e.effect).is_delay}
    punctual = [j for j in range(problem.n_dof) if j not in known_late]

    def beside_delay(n: int, r: np.ndarray, j: np.ndarray) -> Linear:
        return r, np.concatenate([j, _late(problem, tangent.pieces[n], sigma)[..., punctual]], axis=2)

    of_all = np.ones(len(effects), dtype=bool)
    yield slower, of_all
    yield beside_delay, of_all


def _slower(problem: Problem, keep: np.ndarray, x: np.ndarray) -> np.ndarray:
    rate = problem.rate / max(1, int(median_step(keep)))
    return low_pass(x.reshape(x.shape[0], -1), rate, NARROWER * problem.bandwidth).reshape(x.shape)


def _late(problem: Problem, piece: Segment, sigma: np.ndarray) -> np.ndarray:
    """What a small delay of each joint's torque signal would change, shape (len(keep), dof, dof).

    Filters of drives delay by a millisecond, too little to be named, and lean on laws of speed.
    """
    smooth = low_pass(piece.tau, problem.rate, problem.bandwidth)
    rate = np.gradient(smooth, 1 / problem.rate, axis=0)[piece.keep]
    return (rate * piece.counts / sigma)[..., None] * np.eye(problem.n_dof)


def widened(intervals: Intervals, errors: dict[str, float]) -> Intervals:
    """p̂ ± √(h² + δp²): intervals of half-width h widened by misspecification errors δp."""
    out = {}
    for name, (low, high) in intervals.items():
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        half = float(np.hypot(half, errors.get(name, 0.0)))
        out[name] = (middle - half, middle + half)
    return out
