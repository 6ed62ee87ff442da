"""Unexcited rivals: laws that the motion does not show, yet whose columns explain the torque of a named effect."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.identifiability.rivals import Comparison, compare_with_rivals
from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.regression.cross_validation import Fit, NormalEquations, assemble
from lagnet.diagnosis.regression.library import Hypothesis, Library
from lagnet.diagnosis.regression.normal_equations import ridge_solve
from lagnet.diagnosis.selection.arm_search import Selection
from lagnet.diagnosis.selection.holdout_gain import error_of
from lagnet.diagnosis.selection.sublibrary import narrow
from lagnet.effects.catalogue import effect_named
from lagnet.types import has_regressor

FEW = 20  # valid samples of a joint, below which nothing is compared
LEAST_RIDGE = 1e-12  # of a column's power: columns of one body are almost the same while little moves


def with_unexcited_rivals(
    problem: Problem, library: Library, found: Selection, comparisons: tuple[Comparison, ...]
) -> tuple[Comparison, ...]:
    """The comparisons, with ties to laws that the library abstains from although they fit the recordings as well.

    Friction that grows with a load which never varies, for instance, cannot be found, and is dry friction's equal.
    """
    others = unexcited_hypotheses(problem, library, found)
    if not others:
        return comparisons
    equations, selected, number = narrow(problem, library, found, others)
    own = [c for c in compare_with_rivals(equations, selected) if c.index not in selected.arm_wide]
    more = {number[c.index]: {*c.tied, *arm_wide_equals(equations, selected, c.index)} for c in own}
    return tuple(replace(c, tied=tuple(sorted({*c.tied, *more.get(c.index, ())}))) for c in comparisons)


def unexcited_hypotheses(problem: Problem, library: Library, found: Selection) -> tuple[Hypothesis, ...]:
    """Unexcited hypotheses at joints where an effect is named that they are easily confused with."""
    named = {(library.hypotheses[i].effect, library.hypotheses[i].joint) for i in found.indices}
    has_bodies = has_regressor(problem.nominal)
    summary = problem.summary() if library.abstentions and named else None
    out: list[Hypothesis] = []
    for abstained in library.abstentions:
        law, joint = effect_named(abstained.effect), abstained.joint
        rivals = any((other, joint) in named for other in law.confused_with)
        if summary is None or joint is None or not rivals or (law.needs_bodies and not has_bodies):
            continue
        shapes = law.shapes(summary, joint)
        hypotheses = (Hypothesis(law.name, joint, tuple(sorted(shape.items()))) for shape in shapes)
        out.extend(h for h in hypotheses if h.is_plain)
    return tuple(out)


def arm_wide_equals(equations: NormalEquations, found: Selection, index: int) -> set[str]:
    """Names of arm-wide laws of the same joint whose squared error in the place of an effect is hardly larger.

    They are fitted and judged on the same samples: bodies are always there, if only as modelled, and owe nothing for
    columns that the motion does not excite.
    """
    hypotheses = equations.library.hypotheses
    shown = equations.samples >= FEW  # of joints at rest, a few stray samples are no evidence
    equations = replace(equations, total=tuple(t * s for t, s in zip(equations.total, shown, strict=True)))
    sigma = found.sigma(equations)
    pieces = equations.samples / found.scales.inefficiency
    floor = np.maximum(1e-3 * found.scales.noise_power, 1e-300)
    others = [i for i in found.indices if i != index]
    here = _error(equations, found.indices, sigma)
    limits = equations.limits
    same = np.maximum(
        limits.same_error * here, limits.least_of_residual * np.array([t[-1, -1] for t in equations.total])
    )
    equal = set()
    for k in equations.library.reaching:
        if k not in found.arm_wide and hypotheses[k].joint == hypotheses[index].joint:
            there = _error(equations, (*others, k), sigma)
            gap = 0.5 * np.sum(pieces * np.log(np.maximum(there, floor) / np.maximum(here, floor)))
            if gap < limits.tie_odds * np.log(10.0) or np.all(there - here <= same):
                equal.add(hypotheses[k].effect)
    return equal


def _error(equations: NormalEquations, selection: Sequence[int], sigma: np.ndarray) -> np.ndarray:
    """E_j of a selection on the samples that it is fitted to, shape (dof,) [N² m²]."""
    starts = np.concatenate([[0], np.cumsum([equations.library.widths[i] for i in selection])]).astype(int)
    where = {i: np.arange(starts[n], starts[n + 1]) for n, i in enumerate(selection)}
    gram, moment = assemble(equations, selection, where, sigma, [t[None] for t in equations.total])
    theta = ridge_solve(gram, moment, LEAST_RIDGE)[0]
    return error_of(Fit(tuple(selection), {i: theta[rows] for i, rows in where.items()}, np.zeros(0)), equations)
