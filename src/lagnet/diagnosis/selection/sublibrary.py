"""A library of few hypotheses: the selected ones and their rivals."""

from __future__ import annotations

from collections.abc import Sequence

from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.regression.block_gram import collect_block_grams
from lagnet.diagnosis.regression.cross_validation import Fit, NormalEquations, sum_normal_equations
from lagnet.diagnosis.regression.library import Hypothesis, Library
from lagnet.diagnosis.selection.arm_search import Selection, refit_selection


def narrow(
    problem: Problem, library: Library, found: Selection, others: Sequence[Hypothesis]
) -> tuple[NormalEquations, Selection, dict[int, int]]:
    """Normal equations of the selected hypotheses and some others alone.

    Args:
        problem, library, found: of a diagnosis.
        others: hypotheses to stand beside the selected ones, whether the library has them or not.

    Returns:
        Workbench and selection of the narrow library, and the numbers of its selected hypotheses in the wide one.
    """
    kept = [library.hypotheses[i] for i in found.indices]
    widths = [h.law.bounds(dict(h.shape))[0].size for h in (*kept, *others)]
    small = Library((*kept, *others), tuple(widths), library.n_dof, ())
    equations = sum_normal_equations(small, collect_block_grams(problem, small, problem.fit), problem.limits)
    number = {i: n for n, i in enumerate(found.indices)}
    fit = Fit(tuple(number.values()), {number[i]: c for i, c in found.fit.coefficients.items()}, found.fit.sse)
    arm_wide = tuple(number[i] for i in found.arm_wide)
    local = tuple(tuple(number[i] for i in own) for own in found.local)
    selected = refit_selection(equations, Selection(arm_wide, local, found.score, fit, found.scales))
    return equations, selected, {n: i for i, n in number.items()}
