"""The ties of a diagnosis, as pairs of explanations that another recording may discriminate."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.identifiability.rivals import Comparison, replacements
from lagnet.diagnosis.identifiability.unexcited_rivals import unexcited_hypotheses
from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.regression.cross_validation import NormalEquations, fit_selection
from lagnet.diagnosis.regression.library import Hypothesis, Library
from lagnet.diagnosis.selection.arm_search import Selection, views_of
from lagnet.diagnosis.selection.sublibrary import narrow

Explanation = tuple[tuple[int, ...], np.ndarray]
"""Hypotheses and their coefficients, in one vector."""
Alternatives = tuple[tuple[int, ...], Explanation, list[Explanation]]
"""Joints at which explanations are compared, the one with the named effect, and the others."""


@dataclass(frozen=True, eq=False)
class OpenTie:
    """One effect and the rivals that explain the recordings as well.

    Args:
        effect, joint: the named effect.
        instead_of: names that the rivals replace: the effect, or it and another one.
        rivals: names that replace them together.
        joints: at which the two are compared: that of the effect, or all.
        named: the selection with the effect.
        others: selections with the rivals, one for each of their shapes.
        arm_wide: whether the effect acts on the whole arm.
    """

    effect: str
    joint: int | None
    instead_of: tuple[str, ...]
    rivals: tuple[str, ...]
    joints: tuple[int, ...]
    named: Explanation
    others: tuple[Explanation, ...]
    arm_wide: bool


def open_ties(
    problem: Problem, library: Library, found: Selection, comparisons: tuple[Comparison, ...]
) -> tuple[NormalEquations, Selection, tuple[OpenTie, ...]]:
    """Normal equations and selection of the hypotheses in question alone, and the ties among them, each once."""
    tied = {c.index: set(c.tied) for c in comparisons if c.tied}
    others = _hypotheses_in_question(problem, library, found, tied)
    equations, selected, number = narrow(problem, library, found, others)
    ties: dict[tuple, OpenTie] = {}
    for index in selected.indices:
        for tie in _ties_of(equations, selected, index, tied.get(number[index], set())):
            ties.setdefault((tie.joint, frozenset({tie.instead_of, tie.rivals})), tie)
    return equations, selected, tuple(ties.values())


def _hypotheses_in_question(
    problem: Problem, library: Library, found: Selection, tied: dict[int, set[str]]
) -> list[Hypothesis]:
    """Every shape of the rivals, at the joints of the ties, or at all joints for arm-wide ones."""
    places = {(name, library.hypotheses[i].joint) for i, names in tied.items() for name in names}
    reaching = {n for i, names in tied.items() if library.hypotheses[i].law.reaches_all for n in names}
    chosen = {library.hypotheses[i] for i in found.indices}
    known = (*library.hypotheses, *unexcited_hypotheses(problem, library, found))
    return [h for h in known if h not in chosen and (h.place in places or (h.law.reaches_all and h.effect in reaching))]


def _ties_of(equations: NormalEquations, found: Selection, index: int, tied: set[str]) -> Iterator[OpenTie]:
    hypothesis = equations.library.hypotheses[index]
    views = [_arm_alternatives(equations, found, index)]
    if not hypothesis.law.reaches_all:
        views.append(_joint_alternatives(equations, found, index))
    for joints, named, others in views:
        for (lost, gained), explanations in _by_names(equations, named[0], others).items():
            if gained and set(gained) <= tied:
                arm_wide = hypothesis.law.reaches_all
                yield OpenTie(hypothesis.effect, hypothesis.joint, lost, gained, joints, named, explanations, arm_wide)


def _by_names(
    equations: NormalEquations, named: tuple[int, ...], others: list[Explanation]
) -> dict[tuple[tuple[str, ...], tuple[str, ...]], tuple[Explanation, ...]]:
    """The alternatives by the names that they remove and those that they add."""
    grouped: dict = {}
    for selection, theta in others:
        lost = tuple(sorted(equations.library.hypotheses[i].effect for i in named if i not in selection))
        gained = tuple(sorted(equations.library.hypotheses[i].effect for i in selection if i not in named))
        grouped[lost, gained] = (*grouped.get((lost, gained), ()), (selection, theta))
    return grouped


def _joint_alternatives(equations: NormalEquations, found: Selection, index: int) -> Alternatives:
    """Replacements at one joint, with the arm-wide effects fixed."""
    joint = equations.library.hypotheses[index].joint or 0
    own, view = found.local[joint], views_of(equations, found)[joint]
    others = [o for _, o in replacements(view, own, index) if np.isfinite(view.score(o))]
    return (joint,), (own, view.coefficients(own)), [(o, view.coefficients(o)) for o in others]


def _arm_alternatives(equations: NormalEquations, found: Selection, index: int) -> Alternatives:
    """Replacements on the whole arm: by an arm-wide effect; for an effect of one joint, by one of that joint."""
    hypotheses = equations.library.hypotheses
    sigma = found.sigma(equations)
    others = tuple(i for i in found.indices if i != index)
    added = [
        k for k in equations.library.reaching if k not in others and hypotheses[k].place != hypotheses[index].place
    ]
    if not hypotheses[index].law.reaches_all:
        added = [k for k in added if hypotheses[k].joint == hypotheses[index].joint]
    out = []
    for selection in (found.indices, *((*others, k) for k in added)):
        fit = fit_selection(equations, selection, sigma, folds=False)
        out.append((selection, np.concatenate([fit.coefficients[i] for i in selection])))
    return tuple(range(equations.library.n_dof)), out[0], out[1:]
