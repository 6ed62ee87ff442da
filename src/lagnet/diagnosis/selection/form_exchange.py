"""Forms of one law: S with i made linear about its own coefficients, or with another form k of i for it and for j.

Friction per torque of the motor is friction per torque of the link and a gain, in motion. A search that exchanges one
hypothesis for another does not get from those two to the one, since it has to pass the motor's side beside a gain. One
cause stands unless two gain as much over it as a law must gain over its special case: they differ in the blurred
changes of direction, where a free number more always fits.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.regression.block_gram import collect_block_grams
from lagnet.diagnosis.regression.cross_validation import NormalEquations, sum_normal_equations
from lagnet.diagnosis.regression.library import Hypothesis, Library
from lagnet.diagnosis.selection.arm_search import Selection, refit_selection, views_of
from lagnet.diagnosis.selection.joint_search import gains_over
from lagnet.diagnosis.selection.joint_view import JointView

MADE_GOOD = 0.1  # of what an effect explains beside one form of a law: more is lost where it is no part of the other


def exchange_forms(problem: Problem, equations: NormalEquations, found: Selection) -> tuple[NormalEquations, Selection]:
    """A selection whose laws of several forms are linear about their own coefficients, each in its plainest form.

    Args:
        problem: gives the columns.
        equations: normal equations of the fitted blocks.
        found: a selection of their library.

    Returns:
        The same where there is nothing to exchange; else with the hypotheses that came in.
    """
    sharper = {i: h for i in found.indices if (h := _sharper(equations.library, found, i)) is not None}
    if not sharper:
        return equations, found
    library = equations.library
    fresh = {i: len(library.hypotheses) + n for n, i in enumerate(sharper)}
    wider = library.with_more([*sharper.values()], [library.widths[i] for i in sharper])
    same = {j for j in range(problem.n_dof) if not any(h.law.reaches_all or h.joint == j for h in sharper.values())}
    known = {j: gram for j, gram in enumerate(equations.grams.joints) if j in same}
    equations = sum_normal_equations(wider, collect_block_grams(problem, wider, problem.fit, known), problem.limits)
    found = refit_selection(equations, found)
    views = views_of(equations, found)
    local = tuple(_exchanged(view, own, fresh) for view, own in zip(views, found.local, strict=True))
    return equations, refit_selection(equations, replace(found, local=local))


def _sharper(library: Library, found: Selection, index: int) -> Hypothesis | None:
    """A selected hypothesis made linear about what its coefficients tell; None where it is so already."""
    h = library.hypotheses[index]
    beside = {library.hypotheses[k].effect for k in found.indices if library.hypotheses[k].joint == h.joint}
    shape = h.law.sharper_shape(found.fit.coefficients[index], dict(h.shape), beside)
    return None if shape is None else replace(h, shape=tuple(sorted(shape.items())))


def _exchanged(view: JointView, own: tuple[int, ...], fresh: dict[int, int]) -> tuple[int, ...]:
    """Local hypotheses with the fresh ones in the place of those that they were made of, where they fit as well."""
    for i in [i for i in own if i in fresh]:
        k = fresh[i]
        alone = tuple(k if n == i else n for n in own)
        likely = [one for j in own if j != i and (one := _likely(view, own, i, j, k))]
        same_form = _form(view.equations.library, i) == _form(view.equations.library, k)
        if likely:
            own = max(likely, key=view.score)
        elif same_form and view.score(alone) > view.score(own):
            own = alone
    return own


def _likely(view: JointView, own: tuple[int, ...], i: int, j: int, k: int) -> tuple[int, ...] | None:
    """S ∪ {k} \\ {i, j}, if k also makes good what j explains beside i; else None."""
    rest = tuple(n for n in own if n != j)
    one = tuple(k if n == i else n for n in rest)
    lost = view.error(one) - view.error(own)
    if not np.isfinite(view.score(one)) or lost > MADE_GOOD * (view.error(rest) - view.error(own)):
        return None
    return None if gains_over(view, own, i, one) else one


def _form(library: Library, index: int) -> tuple[tuple[str, float], ...]:
    h = library.hypotheses[index]
    return tuple((name, value) for name, value in h.shape if name in h.law.settled)
