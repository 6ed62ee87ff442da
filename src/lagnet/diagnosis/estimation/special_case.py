"""E(special case) − E(law) > least gain: a free value stands where it leaves noticeably less than a plain one.

A coupled motor of ratio one is the special case of one of any ratio. A free number follows noise, and what is of no
law's form, a little better than a plain one: that is no evidence against a gear of equal wheels.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.estimation.refit import Refit, refit
from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.diagnosis.problem.residuals import left_by
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import NamedEffect


def with_special_cases(problem: Problem, fitted: Refit, sigma: np.ndarray) -> Refit:
    """The refit with each law in its special case, all else fitted anew, but for laws that leave noticeably less.

    Args:
        fitted: of all effects together, with free values.
        sigma: shape (dof,), the joints' weights in the fit [N m].
    """
    for n, effect in enumerate(fitted.effects):
        case = effect_named(effect.effect).special_case(effect.values)
        if case is not None:
            plain = replace(effect, values={**effect.values, **case})
            other = refit(problem, [*fitted.effects[:n], plain, *fitted.effects[n + 1 :]], sigma)
            if not _leaves_less(problem, n, fitted.effects, other.effects):
                return with_special_cases(problem, other, sigma)
    return fitted


def _leaves_less(problem: Problem, n: int, free: Sequence[NamedEffect], plain: Sequence[NamedEffect]) -> bool:
    """Whether effect n with its free values leaves less at some joint: noticeably where fitted, and where held out."""
    limits = problem.limits
    absent = [e for k, e in enumerate(free) if k != n]
    nominal, without, before, after = (_power(problem, problem.fit, e) for e in ((), absent, plain, free))
    explained = np.minimum(without - after, problem.scale**2)
    shares = (limits.least_share * before, limits.least_over_special_case * explained)
    least = limits.least_power_of(effect_named(free[n].effect), problem.scale**2, nominal, after)
    noticeable = before - after > np.maximum.reduce([*shares, least])
    confirmed = _power(problem, problem.holdout, free) <= _power(problem, problem.holdout, plain)
    return bool(np.any(noticeable & confirmed))


def _power(problem: Problem, segments: Sequence[Segment], effects: Sequence[NamedEffect]) -> np.ndarray:
    """Mean squared residual of each joint, shape (dof,) [N² m²]."""
    return np.mean(left_by(problem, segments, effects) ** 2, axis=0)
