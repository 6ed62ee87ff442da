"""What stands in the place of a step of the diagnosis that is no rule and has no parameter, while it is taken out.

Each function takes what stands there and gives back what does nothing in its place. Most find what they give back among
their arguments by its kind, so that they outlive small changes of how they are called.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from lagnet.diagnosis.identifiability.rivals import Comparison
from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.regression.cross_validation import Fit, NormalEquations, fit_selection
from lagnet.diagnosis.selection.arm_search import Selection
from lagnet.diagnosis.selection.holdout_gain import error_of
from lagnet.diagnosis.selection.joint_search import best_addition, drop_immaterial
from lagnet.diagnosis.selection.joint_view import JointView

ROUNDING = 1e-7  # of a joint's torque: the noise floor where no noise is known


def first_argument(old: Callable) -> Callable:
    """A step that gives back what it was given first."""
    return lambda *given, **more: given[0]


def value(x: Any) -> Callable[[Any], Any]:
    """A constant, or a function of anything that gives the constant back."""
    return lambda old: (lambda *given, **more: x) if callable(old) else x


def no_noise(old: Callable) -> Callable:
    """A noise floor of rounding alone."""
    return lambda *given, **more: ROUNDING * next(x for x in given if isinstance(x, Problem)).scale


def first_come(old: Callable) -> Callable:
    """A search that takes up the best hypothesis again and again and never exchanges one."""

    def search(view: JointView, warm: tuple[int, ...] = ()) -> tuple[int, ...]:
        selection: tuple[int, ...] = ()
        while True:
            score, best = best_addition(view, selection, selection)
            if not score > view.score(selection):
                return drop_immaterial(view, selection)
            selection = best

    return search


def error_where_fitted(old: Callable) -> Callable:
    """Error of the fit to all blocks of a joint on these same blocks: one fold, held again by the fit without it."""
    return lambda total, folds: old(2.0 * total, total[None])


def arm_error_where_fitted(old: Callable) -> Callable:
    """The same for all joints together."""

    def error(equations: NormalEquations, order: Any, where: dict, sigma: np.ndarray) -> np.ndarray:
        fit: Fit = fit_selection(equations, order, sigma, folds=False)
        return error_of(fit, equations)

    return error


def arm_theta_where_fitted(old: Callable) -> Callable:
    """Coefficients of the fit to all blocks in the place of those without a fold."""

    def theta(equations: NormalEquations, order: Any, where: dict, sigma: np.ndarray) -> np.ndarray:
        fit: Fit = fit_selection(equations, order, sigma, folds=False)
        return np.concatenate([fit.coefficients[i] for i in order])[None]

    return theta


def block_errors_where_fitted(old: Callable) -> Callable:
    """Errors in blocks of the fit to all of them: two folds, each of everything, of which one is left out."""
    return lambda blocks, folds, columns: old(blocks, np.stack([folds.sum(axis=0)] * 2), columns)


def white(old: Callable) -> Callable:
    """Covariance of a fit whose residuals are independent from sample to sample, and their number."""

    def covariance(work: Any, x: np.ndarray) -> tuple[np.ndarray, int]:
        rest, jacobian = work.residuals(x), work.jacobian(x, np.ones(x.size, dtype=bool))
        flat = np.concatenate([j.reshape(-1, x.size) for j in jacobian])
        count = int(sum(p.counts.sum() for p in work.pieces))
        power = sum(float(np.sum(r**2)) for r in rest) / max(1, count - x.size)
        return np.linalg.pinv(flat.T @ flat, hermitian=True) * power, max(2, count - x.size)

    return covariance


def without_rivals(old: Callable) -> Callable:
    """Comparisons of the selected hypotheses with nothing."""

    def alone(*given: Any, **more: Any) -> tuple[Comparison, ...]:
        found = next(x for x in (*given, *more.values()) if isinstance(x, Selection))
        return tuple(Comparison(i, (), ()) for i in found.indices)

    return alone


def comparisons_as_they_are(old: Callable) -> Callable:
    """The comparisons that are given, with no ties added."""

    def unchanged(*given: Any, **more: Any) -> tuple[Comparison, ...]:
        tuples = (x for x in (*given, *more.values()) if isinstance(x, tuple))
        return next(x for x in tuples if all(isinstance(c, Comparison) for c in x))

    return unchanged


def start_as_it_is(old: Callable) -> Callable:
    """A descent, or a move to physical bodies, that stays at its start."""
    return lambda work, x, *free: x


def full_friction_at_rest(old: Callable) -> Callable:
    """No joint keeps a known share of its dry friction while it rests."""
    return lambda problem, effects: np.zeros(problem.n_dof)
