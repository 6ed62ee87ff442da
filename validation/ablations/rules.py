"""The rules of a verdict, and what stands in the diagnosis where each is taken out.

Neutral functions find what they give back among their arguments by its kind, so that they outlive small changes of how
they are called.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.problem import Problem
from lagnet.diagnosis.refit import Refit
from lagnet.diagnosis.rivals import Contest
from lagnet.diagnosis.search import JointView, drop_immaterial, plain_moves
from validation.ablations.taken_out import Instead

ROUNDING = 1e-7  # of a joint's torque: the noise floor where no noise is known


@dataclass(frozen=True)
class Ablation:
    """One rule that is taken out.

    Args:
        name: of the rule.
        instead_of: what the diagnosis does then, in words.
        instead: what stands in its places.
    """

    name: str
    instead_of: str
    instead: Instead


def _first(kind: type) -> Callable[[Any], Callable]:
    """A function that gives back its first argument of a kind."""
    return lambda old: lambda *given, **more: next(x for x in (*given, *more.values()) if isinstance(x, kind))


def _the(kind: type, given: tuple) -> Any:
    return next(x for x in given if isinstance(x, kind))


def _value(value: Any) -> Callable[[Any], Any]:
    """A constant, or a function of anything that gives a constant back."""
    return lambda old: (lambda *given, **more: value) if callable(old) else value


def _no_noise(old: Callable) -> Callable:
    return lambda *given, **more: ROUNDING * _the(Problem, given).scale


def _first_come(old: Callable) -> Callable:
    """A search that takes up the best hypothesis again and again and never exchanges one."""

    def search(view: JointView, warm: tuple[int, ...] = ()) -> tuple[int, ...]:
        selection: tuple[int, ...] = ()
        while True:
            longer = [s for s in plain_moves(view, selection) if len(s) > len(selection)]
            best = max(longer, key=view.score, default=selection)
            if not view.score(best) > view.score(selection):
                return drop_immaterial(view, selection)
            selection = best

    return search


def _error_where_fitted(old: Callable) -> Callable:
    """Error of the fit to all blocks on these same blocks."""

    def joint_loss(bench_total: np.ndarray, folds: np.ndarray, columns: np.ndarray) -> tuple[float, np.ndarray]:
        _, theta = old(bench_total, folds, columns)
        inner = bench_total[np.ix_(columns, columns)]
        error = bench_total[-1, -1] - 2.0 * theta @ bench_total[columns, -1] + theta @ inner @ theta
        return float(max(error, 0.0)), theta

    return joint_loss


def _arm_error_where_fitted(old: Callable) -> Callable:
    """The same for all joints together."""
    from lagnet.diagnosis.evidence_of import error_of
    from lagnet.diagnosis.fitting import Fit, fit_selection

    def error(bench: Any, order: Any, where: dict, sigma: np.ndarray) -> np.ndarray:
        fit: Fit = fit_selection(bench, order, sigma, folds=False)
        return error_of(fit, bench)

    return error


def _white(old: Callable) -> Callable:
    """Covariance of a fit whose residuals are independent from sample to sample, and their number."""

    def covariance(work: Any, x: np.ndarray) -> tuple[np.ndarray, int]:
        rest, jacobian = work.residuals(x), work.jacobian(x, np.ones(x.size, dtype=bool))
        flat = np.concatenate([j.reshape(-1, x.size) for j in jacobian])
        count = int(sum(p.counts.sum() for p in work.pieces))
        power = sum(float(np.sum(r**2)) for r in rest) / max(1, count - x.size)
        return np.linalg.pinv(flat.T @ flat, hermitian=True) * power, max(2, count - x.size)

    return covariance


def _uncontested(old: Callable) -> Callable:
    return lambda *given, **more: tuple(Contest(i, (), ()) for i in _the(Found, given).selection)


def _contests_as_they_are(old: Callable) -> Callable:
    def unchanged(*given: Any, **more: Any) -> tuple[Contest, ...]:
        tuples = (x for x in (*given, *more.values()) if isinstance(x, tuple))
        return next(x for x in tuples if all(isinstance(c, Contest) for c in x))

    return unchanged


def _last(kinds: tuple[type, ...]) -> Callable[[Any], Callable]:
    """A function that gives back its arguments of some kinds, in their order."""
    return lambda old: lambda *given, **more: tuple(x for x in (*given, *more.values()) if isinstance(x, kinds))


SINGLE = (
    Ablation("nothing", "the diagnosis as it is", {}),
    Ablation(
        "noise floor",
        "no noise is known: every residual is a mismatch",
        {"lagnet.diagnosis.noise_floor:noise_floor": _no_noise},
    ),
    Ablation(
        "ceiling",
        "no name is withdrawn for what it leaves unexplained",
        {"lagnet.diagnosis.adequacy:withdraw": _first(Found)},
    ),
    Ablation(
        "rivals",
        "the best hypothesis is taken up, then the next; none is exchanged for another",
        {
            "lagnet.diagnosis.search:search_joint": _first_come,
            "lagnet.diagnosis.settle:prefer_plain": _first(Found),
        },
    ),
    Ablation(
        "held-out gate",
        "what does not help on held-out recordings stays",
        {
            "lagnet.diagnosis.settle:HARMLESS": _value(-np.inf),
            "lagnet.diagnosis.echoes:drop_echoes": _last((Found, Refit)),
        },
    ),
    Ablation(
        "unseen blocks",
        "hypotheses are judged on the data that they are fitted to",
        {
            "lagnet.diagnosis.fitting:joint_loss": _error_where_fitted,
            "lagnet.diagnosis.fitting:_unseen_error": _arm_error_where_fitted,
        },
    ),
    Ablation(
        "blocks of time",
        "noise is white, and every sample a piece of evidence of its own",
        {
            "lagnet.diagnosis.fitting:memory_of": _value(1.0),
            "lagnet.diagnosis.arm_search:FIRST_MEMORY": _value(1.0),
            "lagnet.diagnosis.refit_work:Work.covariance": _white,
            "lagnet.diagnosis.passing:_caution": _value(1.0),
        },
    ),
    Ablation(
        "ties",
        "the selected name stands alone, whatever else would explain the data",
        {
            "lagnet.diagnosis.rivals:hold_contests": _uncontested,
            "lagnet.diagnosis.unjudged:contests_with_unjudged": _contests_as_they_are,
            "lagnet.diagnosis.equal_in_motion:tie_equals": _contests_as_they_are,
        },
    ),
    Ablation(
        "joint refit",
        "parameters stay as the search found them, on its grid of shapes",
        {
            "lagnet.diagnosis.refit_work:Work.descend": lambda old: lambda work, x, free: x,
            "lagnet.diagnosis.refit:made_real": lambda old: lambda work, x: x,
        },
    ),
)
"""The whole diagnosis first, then one rule taken out at a time."""


def _together(*names: str) -> Ablation:
    """Several rules taken out at once, where each may stand in for another."""
    single = {a.name: a for a in SINGLE}
    places = {place: neutral for name in names for place, neutral in single[name].instead.items()}
    return Ablation(" + ".join(names), "several rules are taken out at once", places)


ABLATIONS = (
    *SINGLE,
    _together("ceiling", "held-out gate"),
    _together("noise floor", "ceiling", "held-out gate", "unseen blocks", "blocks of time"),
)
"""Those, and rules that may stand in for each other taken out together."""


def ablation_named(name: str) -> Ablation:
    """One of them.

    Raises:
        KeyError: there is none of that name.
    """
    return {a.name: a for a in ABLATIONS}[name]
