"""The ties that a diagnosis left open, as pairs of explanations that another recording may tell apart."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.arm_search import Found, views_of
from lagnet.diagnosis.fitting import Workbench, fit_selection
from lagnet.diagnosis.library import Hypothesis, Library
from lagnet.diagnosis.narrowed import narrow
from lagnet.diagnosis.problem import Problem
from lagnet.diagnosis.rivals import Contest, replacements
from lagnet.diagnosis.unjudged import unjudged

Explanation = tuple[tuple[int, ...], np.ndarray]
"""Hypotheses and their coefficients, in one vector."""
Alternatives = tuple[tuple[int, ...], Explanation, list[Explanation]]
"""Joints at which explanations are compared, the one with the named effect, and the others."""


@dataclass(frozen=True, eq=False)
class OpenTie:
    """One effect and the names that could stand in its place.

    Args:
        effect, joint: the named effect.
        instead_of: what the rivals replace: the effect, or it and a neighbour.
        rivals: names that explain the recordings as well, together in its place.
        joints: where the two are compared: its joint, or all of them.
        named: the selection with the effect.
        others: selections with the rivals, one for each of their shapes.
        far: whether the effect itself reaches all joints.
    """

    effect: str
    joint: int | None
    instead_of: tuple[str, ...]
    rivals: tuple[str, ...]
    joints: tuple[int, ...]
    named: Explanation
    others: tuple[Explanation, ...]
    far: bool


def open_ties(
    problem: Problem, library: Library, found: Found, contests: tuple[Contest, ...]
) -> tuple[Workbench, Found, tuple[OpenTie, ...]]:
    """Workbench and selection of the hypotheses in question alone, and the ties among them, each told once."""
    tied = {c.index: set(c.tied) for c in contests if c.tied}
    others = _hypotheses_in_question(problem, library, found, tied)
    bench, selected, number = narrow(problem, library, found, others)
    ties: dict[tuple, OpenTie] = {}
    for index in selected.selection:
        for tie in _ties_of(bench, selected, index, tied.get(number[index], set())):
            ties.setdefault((tie.joint, frozenset({tie.instead_of, tie.rivals})), tie)
    return bench, selected, tuple(ties.values())


def _hypotheses_in_question(
    problem: Problem, library: Library, found: Found, tied: dict[int, set[str]]
) -> list[Hypothesis]:
    """Every shape of the rivals, at the joints of the ties or, where they reach all joints, anywhere."""
    places = {(name, library.hypotheses[i].joint) for i, names in tied.items() for name in names}
    reaching = {n for i, names in tied.items() if library.hypotheses[i].law.reaches_all for n in names}
    chosen = {library.hypotheses[i] for i in found.selection}
    known = (*library.hypotheses, *unjudged(problem, library, found))
    return [h for h in known if h not in chosen and (h.place in places or (h.law.reaches_all and h.effect in reaching))]


def _ties_of(bench: Workbench, found: Found, index: int, tied: set[str]) -> Iterator[OpenTie]:
    hypothesis = bench.library.hypotheses[index]
    views = [_arm_alternatives(bench, found, index)]
    if not hypothesis.law.reaches_all:
        views.append(_joint_alternatives(bench, found, index))
    for joints, named, others in views:
        for (lost, gained), explanations in _by_names(bench, named[0], others).items():
            if gained and set(gained) <= tied:
                far = hypothesis.law.reaches_all
                yield OpenTie(hypothesis.effect, hypothesis.joint, lost, gained, joints, named, explanations, far)


def _by_names(
    bench: Workbench, named: tuple[int, ...], others: list[Explanation]
) -> dict[tuple[tuple[str, ...], tuple[str, ...]], tuple[Explanation, ...]]:
    """The alternatives by the names that they take away and those that they put instead."""
    grouped: dict = {}
    for selection, theta in others:
        lost = tuple(sorted(bench.library.hypotheses[i].effect for i in named if i not in selection))
        gained = tuple(sorted(bench.library.hypotheses[i].effect for i in selection if i not in named))
        grouped[lost, gained] = (*grouped.get((lost, gained), ()), (selection, theta))
    return grouped


def _joint_alternatives(bench: Workbench, found: Found, index: int) -> Alternatives:
    """At one joint, under the far-reaching effects as they are."""
    joint = bench.library.hypotheses[index].joint or 0
    own, view = found.local[joint], views_of(bench, found)[joint]
    others = [o for _, o in replacements(view, own, index) if np.isfinite(view.score(o))]
    return (joint,), (own, view.loss(own)[1]), [(o, view.loss(o)[1]) for o in others]


def _arm_alternatives(bench: Workbench, found: Found, index: int) -> Alternatives:
    """On the whole arm: a far-reaching effect beside the rest of the selection; for an effect of one joint, there."""
    hypotheses = bench.library.hypotheses
    sigma = found.sigma(bench)
    rest = tuple(i for i in found.selection if i != index)
    fresh = [k for k in bench.library.reaching if k not in rest and hypotheses[k].place != hypotheses[index].place]
    if not hypotheses[index].law.reaches_all:
        fresh = [k for k in fresh if hypotheses[k].joint == hypotheses[index].joint]
    out = []
    for selection in (found.selection, *((*rest, k) for k in fresh)):
        fit = fit_selection(bench, selection, sigma, folds=False)
        out.append((selection, np.concatenate([fit.coefficients[i] for i in selection])))
    return tuple(range(bench.library.n_dof)), out[0], out[1:]
