"""Hypotheses whose shape is found in the residual of a selection, such as the order of a torque ripple."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lagnet.diagnosis.problem.problem import Problem, Segment, spread_evenly
from lagnet.diagnosis.regression.block_gram import MOST_SAMPLES
from lagnet.diagnosis.regression.cross_validation import NormalEquations
from lagnet.diagnosis.regression.library import Hypothesis, Library
from lagnet.diagnosis.selection.arm_search import Selection
from lagnet.diagnosis.settings import DecisionLimits
from lagnet.effects.catalogue import CATALOGUE
from lagnet.effects.motion import Motion


def proposals_from_residual(problem: Problem, equations: NormalEquations, found: Selection) -> Library | None:
    """The library with the hypotheses that the residual of a selection suggests; None if it suggests none."""
    motion, residual = _left(problem, equations.library, found)
    fresh: list[Hypothesis] = []
    widths: list[int] = []
    for effect in CATALOGUE.values():
        for joint in () if effect.whole_arm else range(problem.n_dof):
            for shape in effect.proposals(motion, joint, residual):
                columns = effect.columns(motion, joint, shape)
                own = columns[:, joint] if effect.reaches_all else columns
                if _worthwhile(own, residual[:, joint], problem.scale[joint], problem.limits):
                    fresh.append(Hypothesis(effect.name, joint, tuple(sorted(shape.items()))))
                    widths.append(columns.shape[-1])
    if not fresh:
        return None
    library = equations.library
    return replace(library, hypotheses=(*library.hypotheses, *fresh), widths=(*library.widths, *widths))


def _left(problem: Problem, library: Library, found: Selection) -> tuple[Motion, np.ndarray]:
    """Motion and residual of the selection on the valid samples, shape (n, dof)."""
    chosen, pieces = library.of(found.indices), spread_evenly(problem.fit, MOST_SAMPLES)
    thetas = [found.fit.coefficients[i] for i in found.indices]
    rests = [_rest(problem, chosen, thetas, piece) for piece in pieces]
    time, q, v, a, load = (
        np.concatenate([getattr(p, name)[p.keep] for p in pieces]) for name in ("time", "q", "v", "a", "load")
    )
    motion = Motion(time, q, v, a, load, problem.slow, problem.nominal, straight=problem.straight)
    return motion, np.concatenate(rests)


def _rest(problem: Problem, chosen: Library, thetas: list[np.ndarray], piece: Segment) -> np.ndarray:
    columns = []
    for joint, table in enumerate(chosen.tables(problem, piece)):
        slots = chosen.slots[joint]
        modelled = [table[:, at] @ thetas[n] for n, at in slots.items()]
        columns.append((table[:, -1] - np.sum(modelled, axis=0)) * piece.counts[:, joint])
    return np.column_stack(columns)


def _worthwhile(columns: np.ndarray, residual: np.ndarray, scale: float, limits: DecisionLimits) -> bool:
    fitted, *_ = np.linalg.lstsq(columns, residual, rcond=1e-10)
    gain = float(np.mean(residual**2) - np.mean((residual - columns @ fitted) ** 2))
    least = max(limits.least_share * float(np.mean(residual**2)), (limits.least_torque * scale) ** 2)
    return gain > least
