"""p̂ = argmin Σ_j ‖e_j(p)‖² / σ_j² within physical bounds: all named effects together by their exact laws."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag
from scipy.stats import t as student

from lagnet.diagnosis.estimation.delta_method import correlations_of, parameter_jacobian
from lagnet.diagnosis.estimation.gauss_newton import start_gauss_newton
from lagnet.diagnosis.estimation.physical_bodies import with_physical_bodies
from lagnet.diagnosis.estimation.slots import Slots
from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.models.corrected.named_effects import NamedEffect


@dataclass(frozen=True, eq=False)
class Refit:
    """Effects with jointly fitted parameters.

    Args:
        effects: in the order given.
        intervals: for each effect, for each parameter, the 95 % interval.
        correlations: shape (n_parameters, n_parameters) of the coordinates of all effects.
    """

    effects: tuple[NamedEffect, ...]
    intervals: tuple[dict[str, tuple[float, float]], ...]
    correlations: np.ndarray


@dataclass(frozen=True, eq=False)
class Tangent:
    """A fit made linear at its end.

    Args:
        pieces: what was fitted.
        residuals, jacobians: of each piece, shapes (len(keep), dof) and (len(keep), dof, n_coordinates), over σ.
        slopes: shape (n_parameters, n_coordinates), of the parameters of all effects in order.
    """

    pieces: tuple[Segment, ...]
    residuals: list[np.ndarray]
    jacobians: list[np.ndarray]
    slopes: np.ndarray


def tangent_at(problem: Problem, effects: Sequence[NamedEffect], sigma: np.ndarray) -> Tangent:
    """Residuals of fitted effects, and how they and the parameters change with the coordinates; see `refit`."""
    work, x = start_gauss_newton(problem, effects, sigma)
    residuals, jacobians = work.linear(x)
    blocks = [parameter_jacobian(e, x[work.slots.of(n)]) for n, e in enumerate(effects)]
    return Tangent(work.pieces, residuals, jacobians, np.asarray(block_diag(*blocks)))


def refit(
    problem: Problem,
    effects: Sequence[NamedEffect],
    sigma: np.ndarray,
    choices_stay: bool = True,
    beside: Sequence[NamedEffect] = (),
) -> Refit:
    """Gauss–Newton from the search's values, joints weighted by 1/σ².

    Args:
        problem: the fit pieces are used, a spread of them where there are very many samples.
        effects: with starting values.
        sigma: shape (dof,), residual of each joint [N m].
        choices_stay: whether values of special cases, such as a ratio of one, are left as they are.
        beside: effects that act as well and stay as they are.
    """
    if not effects:
        return Refit((), (), np.zeros((0, 0)))
    work, start = start_gauss_newton(problem, effects, sigma, choices_stay, beside)
    slots = work.slots
    x = work.descend(np.clip(start, *slots.bounds), np.ones(start.size, dtype=bool))
    x = with_physical_bodies(work, x)
    covariance, freedom = work.covariance(x)
    return Refit(slots.named(x), _intervals(slots, x, covariance, freedom), correlations_of(covariance))


def _intervals(
    slots: Slots, x: np.ndarray, covariance: np.ndarray, freedom: int
) -> tuple[dict[str, tuple[float, float]], ...]:
    width = float(student.ppf(0.975, freedom))
    out = []
    for n in range(len(slots.effects)):
        effect, at = slots.effects[n], slots.of(n)
        here = effect.at_coordinates(x[at]).parameters()
        slopes = parameter_jacobian(effect, x[at])
        variance = np.einsum("pk,kl,pl->p", slopes, covariance[at, at], slopes)
        spread_of = dict(zip(here, width * np.sqrt(np.maximum(variance, 0.0)), strict=True))
        out.append({k: (float(x - spread_of[k]), float(x + spread_of[k])) for k, x in here.items()})
    return tuple(out)
