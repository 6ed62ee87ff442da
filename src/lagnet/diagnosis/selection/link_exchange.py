"""A link's mass in the place of a change of a link: Δπ = Δm d with d from the model, where the evidence prefers it.

Ten free parameters of a link tell little of each where motion shows few of their combinations, and pass for those of
a neighbour whose torque is nearly the same. One number of the right link predicts as well, and pays less. The search
tries a mass whose inertia grows with it; here the inertia about the centre may as well stay as it is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.regression.cross_validation import NormalEquations, sum_normal_equations
from lagnet.diagnosis.regression.library import Hypothesis, Library
from lagnet.diagnosis.selection.arm_search import Selection, refit_selection
from lagnet.effects.inertia.link_inertia import in_form, is_mass_alone, mass_alone
from lagnet.types import inertial_parameters_of


def exchange_links(problem: Problem, equations: NormalEquations, found: Selection) -> tuple[NormalEquations, Selection]:
    """A selection with the mass of a link, the same or another, in the place of each link that it explains as well.

    Args:
        problem: gives the links as modelled.
        equations: normal equations of the fitted blocks.
        found: a selection of their library.

    Returns:
        The same where no mass does as well; else with the hypotheses that came in.
    """
    library = equations.library
    links = [i for i in found.arm_wide if library.hypotheses[i].law.changes_link]
    if not links:
        return equations, found
    bodies = inertial_parameters_of(problem.nominal)
    masses = [h for i in library.reaching for h in _masses(library.hypotheses[i], bodies)]
    wider = _in_folds(equations, masses)
    best = refit_selection(wider, found)
    for i in links:
        best = max((best, *_exchanges(wider, best, i)), key=lambda s: s.score)
    chosen = [i for i in best.arm_wide if i >= len(library.hypotheses)]
    if best.arm_wide == found.arm_wide:
        return equations, found
    narrower = _in_blocks(equations, [wider.library.hypotheses[i] for i in chosen])
    index = {i: len(library.hypotheses) + n for n, i in enumerate(chosen)}
    return narrower, refit_selection(narrower, replace(best, arm_wide=tuple(index.get(i, i) for i in best.arm_wide)))


def _exchanges(equations: NormalEquations, found: Selection, link: int) -> Iterator[Selection]:
    """The selection with each mass of a link in the place of a changed link."""
    library = equations.library
    taken = {library.hypotheses[i].place for i in found.arm_wide if i != link}
    for k in library.reaching:
        h = library.hypotheses[k]
        if is_mass_alone(dict(h.shape)) and h.place not in taken:
            arm_wide = tuple(k if i == link else i for i in found.arm_wide)
            yield refit_selection(equations, replace(found, arm_wide=arm_wide))


def _masses(h: Hypothesis, bodies: np.ndarray) -> list[Hypothesis]:
    """The form that the search did not try of a link's hypothesis, its mass with the inertia as modelled."""
    if not h.law.changes_link or h.shape or h.joint is None:
        return []
    return [replace(h, shape=tuple(sorted(shape.items()))) for shape in mass_alone(bodies[h.joint])[1:]]


def _in_folds(equations: NormalEquations, masses: Sequence[Hypothesis]) -> NormalEquations:
    """Sums and folds with those of masses; blocks, which no fit asks for, stay without."""
    library, sums = _summed(equations.library, masses)
    total = tuple(_bordered(t[None], s)[0] for t, s in zip(equations.total, sums, strict=True))
    folds = tuple(_bordered(f, s) for f, s in zip(equations.folds, sums, strict=True))
    return replace(equations, library=library, total=total, folds=folds)


def _in_blocks(equations: NormalEquations, masses: Sequence[Hypothesis]) -> NormalEquations:
    """The normal equations with those of masses."""
    library, sums = _summed(equations.library, masses)
    blocks = tuple(_bordered(b, s) for b, s in zip(equations.grams.joints, sums, strict=True))
    return sum_normal_equations(library, replace(equations.grams, joints=blocks), equations.limits)


def _summed(library: Library, masses: Sequence[Hypothesis]) -> tuple[Library, list[np.ndarray]]:
    """The library with masses, and for each joint the weights of their links' columns, shape (K + 1, m)."""
    free = {h.place: i for i, h in enumerate(library.hypotheses) if h.law.changes_link and not h.shape}
    out = []
    for joint in range(library.n_dof):
        sums = np.zeros((library.width(joint) + 1, len(masses)))
        for n, h in enumerate(masses):
            sums[library.columns_of(joint, [free[h.place]]), [n]] = in_form(np.eye(10), dict(h.shape))[:, 0]
        out.append(sums)
    return library.with_more(masses, [1] * len(masses)), out


def _bordered(blocks: np.ndarray, sums: np.ndarray) -> np.ndarray:
    """Gram matrices with sums of their columns as further ones, before the residual, shape (B, K + m + 1, K + m + 1).

    Args:
        blocks: shape (B, K + 1, K + 1), the residual last.
        sums: weights of the columns, shape (K + 1, m).
    """
    rows, (size, more) = np.flatnonzero(sums.any(axis=1)), sums.shape
    beside, last, end = blocks[:, :, rows] @ sums[rows], size - 1, size - 1 + more
    out = np.empty((len(blocks), size + more, size + more))
    out[:, :last, :last], out[:, end, end] = blocks[:, :last, :last], blocks[:, last, last]
    out[:, :last, end], out[:, end, :last] = blocks[:, :last, last], blocks[:, last, :last]
    out[:, :last, last:end], out[:, end, last:end] = beside[:, :last], beside[:, last]
    out[:, last:end, :last], out[:, last:end, end] = beside[:, :last].transpose(0, 2, 1), beside[:, last]
    out[:, last:end, last:end] = sums[rows].T @ beside[:, rows]
    return out
