"""Rivals that the recordings could not judge: a name is not unique while they would explain the same torque."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.evidence_of import error_of
from lagnet.diagnosis.fitting import Fit, Workbench, assemble, solve
from lagnet.diagnosis.library import Hypothesis, Library
from lagnet.diagnosis.narrowed import narrow
from lagnet.diagnosis.problem import Problem
from lagnet.diagnosis.rivals import SAME, TIE, Contest, hold_contests
from lagnet.diagnosis.search import LEAST_OF_ALL
from lagnet.effects.catalogue import effect_named

FEW = 20  # samples of a joint below which they are no evidence
LEAST_RIDGE = 1e-12  # of a column's power: columns of one body are almost the same while little moves


def contests_with_unjudged(
    problem: Problem, library: Library, found: Found, contests: tuple[Contest, ...]
) -> tuple[Contest, ...]:
    """The contests, with ties to laws that the library abstains from although they fit the recordings as well.

    Friction that grows with a load which never varies, for instance, cannot be found, and is dry friction's equal.
    """
    others = unjudged(problem, library, found)
    if not others:
        return contests
    bench, selected, number = narrow(problem, library, found, others)
    own = [c for c in hold_contests(bench, selected) if c.index not in selected.far]
    more = {number[c.index]: {*c.tied, *far_equals(bench, selected, c.index)} for c in own}
    return tuple(replace(c, tied=tuple(sorted({*c.tied, *more.get(c.index, ())}))) for c in contests)


def unjudged(problem: Problem, library: Library, found: Found) -> tuple[Hypothesis, ...]:
    """Hypotheses that were abstained from, at joints where an effect is named that they are easily confused with."""
    named = {(library.hypotheses[i].effect, library.hypotheses[i].joint) for i in found.selection}
    has_bodies = hasattr(problem.nominal, "link_regressor")
    summary = problem.summary() if library.abstentions and named else None
    out: list[Hypothesis] = []
    for abstained in library.abstentions:
        law, joint = effect_named(abstained.effect), abstained.joint
        rivals = any((other, joint) in named for other in law.confused_with)
        if summary is None or joint is None or not rivals or (law.needs_bodies and not has_bodies):
            continue
        shapes = law.shapes(summary, joint)
        out.extend(Hypothesis(law.name, joint, tuple(sorted(shape.items()))) for shape in shapes)
    return tuple(out)


def far_equals(bench: Workbench, found: Found, index: int) -> set[str]:
    """Names of other laws of the same joint that reach all joints and, put in the place of an effect, err hardly more.

    They are fitted and judged on the same samples: bodies are always there, if only as modelled, and owe nothing for
    columns that the motion does not excite.
    """
    hypotheses = bench.library.hypotheses
    shown = bench.samples >= FEW  # of joints that rest, a few stray samples are no evidence
    bench = replace(bench, total=tuple(t * s for t, s in zip(bench.total, shown, strict=True)))
    sigma = found.sigma(bench)
    pieces = bench.samples / found.scales.memory
    floor = np.maximum(1e-3 * found.scales.noise_power, 1e-300)
    rest = [i for i in found.selection if i != index]
    here = _error(bench, found.selection, sigma)
    same = np.maximum(SAME * here, LEAST_OF_ALL * np.array([t[-1, -1] for t in bench.total]))
    equal = set()
    for k in bench.library.reaching:
        if k not in found.far and hypotheses[k].joint == hypotheses[index].joint:
            there = _error(bench, (*rest, k), sigma)
            gap = 0.5 * np.sum(pieces * np.log(np.maximum(there, floor) / np.maximum(here, floor)))
            if gap < TIE * np.log(10.0) or np.all(there - here <= same):
                equal.add(hypotheses[k].effect)
    return equal


def _error(bench: Workbench, selection: Sequence[int], sigma: np.ndarray) -> np.ndarray:
    """Squared error of a selection on the samples that it is fitted to, shape (dof,)."""
    starts = np.concatenate([[0], np.cumsum([bench.library.widths[i] for i in selection])]).astype(int)
    where = {i: np.arange(starts[n], starts[n + 1]) for n, i in enumerate(selection)}
    gram, moment = assemble(bench, selection, where, sigma, [t[None] for t in bench.total])
    theta = solve(gram, moment, ridge=LEAST_RIDGE)[0]
    return error_of(Fit(tuple(selection), {i: theta[rows] for i, rows in where.items()}, np.zeros(0)), bench)
