"""Hypotheses that only a residual can suggest: the order of a ripple, for instance, is found in what is left over."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.fitting import Workbench
from lagnet.diagnosis.grams import MOST_SAMPLES
from lagnet.diagnosis.library import Hypothesis, Library
from lagnet.diagnosis.problem import Piece, Problem, spread_evenly
from lagnet.diagnosis.search import LEAST_SHARE, LEAST_TORQUE
from lagnet.effects.catalogue import CATALOGUE
from lagnet.effects.motion import Motion


def look_again(problem: Problem, bench: Workbench, found: Found) -> Library | None:
    """The library with the hypotheses that the residual of a selection suggests; None if it suggests none."""
    motion, residual = _left(problem, bench.library, found)
    fresh: list[Hypothesis] = []
    widths: list[int] = []
    for effect in CATALOGUE.values():
        for joint in () if effect.whole_arm else range(problem.n_dof):
            for shape in effect.proposals(motion, joint, residual[:, joint]):
                columns = effect.columns(motion, joint, shape)
                if _worthwhile(columns, residual[:, joint], problem.scale[joint]):
                    fresh.append(Hypothesis(effect.name, joint, tuple(sorted(shape.items()))))
                    widths.append(columns.shape[-1])
    if not fresh:
        return None
    library = bench.library
    return replace(library, hypotheses=(*library.hypotheses, *fresh), widths=(*library.widths, *widths))


def _left(problem: Problem, library: Library, found: Found) -> tuple[Motion, np.ndarray]:
    """Motion and what the selection leaves, on the samples that count, shape (n, dof)."""
    chosen, pieces = _chosen(library, found), spread_evenly(problem.fit, MOST_SAMPLES)
    thetas = [found.fit.coefficients[i] for i in found.selection]
    rests = [_rest(problem, chosen, thetas, piece) for piece in pieces]
    time, q, v, a, load = (
        np.concatenate([getattr(p, name)[p.keep] for p in pieces]) for name in ("time", "q", "v", "a", "load")
    )
    motion = Motion(time, q, v, a, load, problem.slow, problem.nominal, straight=problem.straight)
    return motion, np.concatenate(rests)


def _chosen(library: Library, found: Found) -> Library:
    """The hypotheses of a selection alone, in its order."""
    hypotheses = tuple(library.hypotheses[i] for i in found.selection)
    return Library(hypotheses, tuple(library.widths[i] for i in found.selection), library.n_dof, ())


def _rest(problem: Problem, chosen: Library, thetas: list[np.ndarray], piece: Piece) -> np.ndarray:
    columns = []
    for joint, table in enumerate(chosen.tables(problem, piece)):
        slots = chosen.slots[joint]
        modelled = [table[:, at] @ thetas[n] for n, at in slots.items()]
        columns.append((table[:, -1] - np.sum(modelled, axis=0)) * piece.counts[:, joint])
    return np.column_stack(columns)


def _worthwhile(columns: np.ndarray, residual: np.ndarray, scale: float) -> bool:
    fitted, *_ = np.linalg.lstsq(columns, residual, rcond=1e-10)
    gain = float(np.mean(residual**2) - np.mean((residual - columns @ fitted) ** 2))
    return gain > LEAST_SHARE * float(np.mean(residual**2)) and gain > (LEAST_TORQUE * scale) ** 2
