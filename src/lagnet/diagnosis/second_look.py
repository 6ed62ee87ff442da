"""Hypotheses that only a residual can suggest: the order of a ripple, for instance, is found in what is left over."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.fitting import Workbench
from lagnet.diagnosis.library import Hypothesis, Library
from lagnet.diagnosis.problem import Problem
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
    rests, parts = [], {name: [] for name in ("time", "q", "v", "a", "load")}
    for piece in problem.fit:
        columns = []
        for joint, table in enumerate(library.tables(problem, piece)):
            rest = table[:, -1].copy()
            for i in found.selection:
                if i in library.slots[joint]:
                    rest -= table[:, library.slots[joint][i]] @ found.fit.coefficients[i]
            columns.append(rest * piece.counts[:, joint])
        rests.append(np.column_stack(columns))
        for name, part in parts.items():
            part.append(getattr(piece, name)[piece.keep])
    arrays = {name: np.concatenate(part) for name, part in parts.items()}
    motion = Motion(
        arrays["time"], arrays["q"], arrays["v"], arrays["a"], arrays["load"], problem.slow, problem.nominal
    )
    return motion, np.concatenate(rests)


def _worthwhile(columns: np.ndarray, residual: np.ndarray, scale: float) -> bool:
    fitted, *_ = np.linalg.lstsq(columns, residual, rcond=1e-10)
    gain = float(np.mean(residual**2) - np.mean((residual - columns @ fitted) ** 2))
    return gain > LEAST_SHARE * float(np.mean(residual**2)) and gain > (LEAST_TORQUE * scale) ** 2
