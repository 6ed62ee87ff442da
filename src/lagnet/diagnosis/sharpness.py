"""How quickly dry friction changes sign with speed: the ε of s(v) = tanh(v/ε) that fits each joint best."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lagnet.diagnosis.problem import Problem, spread_evenly

FACTORS = (0.3, 1.0, 3.0, 9.0, 27.0)  # of the blurred speed
CLEAR = 0.98  # of the error at the blurred speed itself, below which another sharpness is taken
MOST_SAMPLES = 60_000  # at full rate: of longer recordings, pieces spread over them
OF_SPEED = 0.2  # of a joint's usual speed: what changes more slowly with speed is no dry friction
STRONG = 0.02  # of the residual that dry friction must explain before its sharpness means anything


def sharpen(problem: Problem) -> Problem:
    """The problem with the blurred speed of each joint at which its friction fits best."""
    slow = problem.slow.copy()
    for joint in range(problem.n_dof):
        usual = float(np.sqrt(np.mean(np.concatenate([p.v[p.keep, joint] for p in problem.fit]) ** 2)))
        factors = [f for f in FACTORS if f <= 1.0 or f * problem.slow[joint] <= OF_SPEED * usual]
        errors = {f: _error(problem, joint, f * problem.slow[joint]) for f in factors}
        without = _error(problem, joint, None)
        best = min(errors, key=lambda f: errors[f])
        matters = errors[1.0] < (1.0 - STRONG) * without
        if matters and errors[best] < CLEAR * errors[1.0]:
            slow[joint] *= best
    return replace(problem, slow=slow)


def _error(problem: Problem, joint: int, slow: float | None) -> float:
    """Squared error of a joint's residual after friction of all kinds, inertia, offset, spring and gain."""
    tables, targets = [], []
    for piece in spread_evenly(problem.fit, MOST_SAMPLES):
        v = piece.v[:, joint]
        columns = [v, v * np.abs(v), piece.a[:, joint], piece.q[:, joint], piece.load[:, joint], np.ones_like(v)]
        if slow is not None:
            columns.append(np.tanh(v / slow))
        weight = piece.counts[:, [joint]]
        tables.append(problem.reduce(piece, np.column_stack(columns)) * weight)
        targets.append(problem.residual(piece)[:, joint] * weight[:, 0])
    table, target = np.concatenate(tables), np.concatenate(targets)
    fitted, *_ = np.linalg.lstsq(table, target, rcond=1e-10)
    return float(np.sum((target - table @ fitted) ** 2))
