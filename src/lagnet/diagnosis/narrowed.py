"""A library of few hypotheses: those selected, and those that they have to be told from."""

from __future__ import annotations

from collections.abc import Sequence

from lagnet.diagnosis.arm_search import Found, refit_found
from lagnet.diagnosis.fitting import Fit, Workbench, make_workbench
from lagnet.diagnosis.grams import collect_grams
from lagnet.diagnosis.library import Hypothesis, Library
from lagnet.diagnosis.problem import Problem


def narrow(
    problem: Problem, library: Library, found: Found, others: Sequence[Hypothesis]
) -> tuple[Workbench, Found, dict[int, int]]:
    """The evidence on the selected hypotheses and some others alone.

    Args:
        problem, library, found: of a diagnosis.
        others: hypotheses to stand beside the selected ones, whether the library has them or not.

    Returns:
        Workbench and selection of the narrow library, and the numbers of its selected hypotheses in the wide one.
    """
    kept = [library.hypotheses[i] for i in found.selection]
    widths = [h.law.bounds(dict(h.shape))[0].size for h in (*kept, *others)]
    small = Library((*kept, *others), tuple(widths), library.n_dof, ())
    bench = make_workbench(small, collect_grams(problem, small, problem.fit))
    number = {i: n for n, i in enumerate(found.selection)}
    fit = Fit(tuple(number.values()), {number[i]: c for i, c in found.fit.coefficients.items()}, found.fit.sse)
    far = tuple(number[i] for i in found.far)
    local = tuple(tuple(number[i] for i in own) for own in found.local)
    selected = refit_found(bench, Found(far, local, found.score, fit, found.scales))
    return bench, selected, {n: i for i, n in number.items()}
