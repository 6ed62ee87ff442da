"""Names that the error of their laws' form leaves open.

Where a law is not quite that of the joint, what it leaves looks like a little of another: a delay that the slow half of
the motion asks for and the fast half denies. An effect whose 95 % intervals, widened by how far parts of the motion
disagree, hold the values at which it would not be there, is not claimed.
"""

from __future__ import annotations

from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.fitting import Workbench
from lagnet.diagnosis.form_error import form_errors, widened
from lagnet.diagnosis.problem import Problem
from lagnet.diagnosis.prune import refit_and_prune, sizes_of
from lagnet.diagnosis.refit import Refit
from lagnet.diagnosis.settle import without
from lagnet.effects.catalogue import effect_named


def drop_unsure(problem: Problem, bench: Workbench, found: Found, fitted: Refit) -> tuple[Found, Refit]:
    """The selection less effects that may be nothing, one by one, the smallest first."""
    while unsure := _unsure(problem, bench, found, fitted):
        sizes = sizes_of(problem, fitted.effects)
        smallest = min(unsure, key=lambda n: sizes[n])
        found, fitted = refit_and_prune(problem, bench, without(bench, found, found.selection[smallest]))
    return found, fitted


def _unsure(problem: Problem, bench: Workbench, found: Found, fitted: Refit) -> list[int]:
    """Places in the selection of the effects that may be nothing."""
    if not fitted.effects:
        return []
    sigma = found.sigma(bench)
    errors = form_errors(problem, fitted.effects, sigma)
    wide = [widened(*pair) for pair in zip(fitted.intervals, errors, strict=True)]
    return [n for n, e in enumerate(fitted.effects) if not effect_named(e.effect).is_determined(wide[n])]
