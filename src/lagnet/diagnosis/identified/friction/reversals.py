"""Friction that builds up after a reversal, where it harms the samples near reversals that no fit uses.

Near zero speed the sign of a noisy speed is not known, and samples there are not fitted. Bristles may then gain a
little on what is fitted and be late where nothing asked them: at twice the error of plain dry friction on 20 s of a
UR10 with 1 mrad of position noise. Samples in motion are predicted, all of them, so all of them are asked.

Bristles of a gear hold no more than its dry friction. Where a joint hardly turns back they are columns of almost
nothing, and what else is left there may give them any weight: 570 N m beside 20 N m of dry friction on three seconds
of a UR10e. A few times the dry friction is left to them, as they may stand for another cause.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lagnet.diagnosis.identified.design import Design, FitSegment, JointRows, usual_rest
from lagnet.diagnosis.identified.equations import joint_equations
from lagnet.diagnosis.identified.evidence import fit_ridge
from lagnet.diagnosis.identified.folds import STEPS, Choice
from lagnet.diagnosis.identified.real_inertia import columns_of
from lagnet.diagnosis.problem.problem import Problem
from lagnet.effects.rest import resting

MOST_HELD = 5.0  # times the dry friction of a joint, friction of its load among it: what a bristle may hold


def excessive_bristles(design: Design, choice: Choice) -> np.ndarray:
    """Unknowns of bristles that hold far more than the dry friction of their joint, |w| > 5 (|F| + |K| rms load)."""
    weights, dry = design.unscaled(choice.ridge.x), np.zeros(len(design.joints))
    for i, term in (*columns_of(design, "dry"), *columns_of(design, "load")):
        rows = design.joints[term.joint]
        column = rows.columns[rows.valid][:, rows.unknowns == i]
        dry[term.joint] += np.sqrt(np.mean(column**2)) * abs(choice.ridge.x[i]) if column.size else 0.0
    excessive = [i for i, t in columns_of(design, "bristle") if abs(weights[i]) > MOST_HELD * dry[t.joint]]
    return np.array(excessive, dtype=int)


def late_bristles(problem: Problem, pieces: Sequence[FitSegment], design: Design, choice: Choice) -> np.ndarray:
    """Unknowns of the bristles without which a joint's torque is predicted better over all its samples in motion.

    Args:
        problem: the diagnosis' problem.
        pieces: fitted motion.
        design: their equations, the rows that are not fitted among them.
        choice: the solution.
    """
    bristles = {i: g for i, g in enumerate(design.groups) if g.name == "bristle" and i not in choice.excluded}
    used = {i: g for i, g in bristles.items() if np.any(design.scale[g.unknowns] > 0)}
    if not used:
        return np.zeros(0, dtype=int)
    fixed = choice.excluded | frozenset(used)
    without = fit_ridge(design, joint_equations(design), choice.inefficiency, choice.ridge, STEPS, fixed)
    late = [
        group.unknowns
        for group in used.values()
        if group.joint is not None
        and _error(design.joints[group.joint], moving := _moving(problem, pieces, group.joint), without.x)
        < _error(design.joints[group.joint], moving, choice.ridge.x)
    ]
    return np.concatenate(late) if late else np.zeros(0, dtype=int)


def _moving(problem: Problem, pieces: Sequence[FitSegment], joint: int) -> np.ndarray:
    """Rows of the equations in which a joint does not rest, fitted or not."""
    speed = usual_rest(problem).speed[joint]
    return np.concatenate([~resting(s.piece.time, s.piece.v[:, joint], speed)[s.piece.keep] for s in pieces])


def _error(rows: JointRows, used: np.ndarray, x: np.ndarray) -> float:
    """Squared error of a joint over some rows."""
    return float(np.sum((rows.target - rows.columns @ x[rows.unknowns])[used] ** 2))
