"""s(v) = tanh(v/ε) or clip(v/ε, −1, 1): the ε and the form by which dry friction changes sign at each joint."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize_scalar

from lagnet.diagnosis.problem.problem import Problem, Segment, spread_evenly
from lagnet.effects.rest import blurred_sign

FACTORS = (0.3, 1.0, 3.0, 9.0, 27.0)  # of the blurred speed
CLEAR = 0.98  # of the squared error at the blurred speed itself, below which another sharpness or form is taken
MOST_SAMPLES = 60_000  # at full rate: of longer recordings, pieces spread over them
OF_SPEED = 0.2  # of a joint's rms speed: what changes more slowly with speed is no dry friction
LINE = 1.5  # times as wide is a straight line that is as steep as tanh on average
STRONG = 0.02  # of the residual that dry friction must explain before its sharpness means anything
STEP = 3.0  # between the factors: as far to either side of the best of them ε is sought
FINE = 0.03  # of ε to which it is sought


@dataclass(frozen=True)
class SignFit:
    """A form of s(v), and the squared error that it leaves."""

    slow: float
    straight: bool
    error: float


def fit_sign_model(problem: Problem) -> Problem:
    """The problem with the blurred speed of each joint, and the form of s(v), at which its friction fits best."""
    slow, straight = problem.slow.copy(), np.zeros(problem.n_dof, dtype=bool)
    for joint in range(problem.n_dof):
        best = _best_sign(problem, joint)
        if best is not None:
            slow[joint], straight[joint] = best.slow, best.straight
    return replace(problem, slow=slow, straight=straight if straight.any() else None)


def _best_sign(problem: Problem, joint: int) -> SignFit | None:
    """The form that is clearly better than tanh at the blurred speed; None: none is, or dry friction matters little."""
    usual = float(np.sqrt(np.mean(np.concatenate([p.v[p.keep, joint] for p in problem.fit]) ** 2)))
    blurred, widest = float(problem.slow[joint]), OF_SPEED * usual
    error, without = _errors(problem, joint)
    plain = SignFit(blurred, False, error(blurred, False))
    if not plain.error < (1.0 - STRONG) * without:
        return None
    others = (f * blurred for f in FACTORS if f != 1.0 and (f < 1.0 or f * blurred <= widest))
    curve = min([plain, *(SignFit(e, False, error(e, False)) for e in others)], key=lambda s: s.error)
    if not curve.error < CLEAR * plain.error:
        return None
    curve = _refined(error, curve, max(widest, blurred))
    line = _refined(error, SignFit(LINE * curve.slow, True, np.inf), LINE * max(widest, blurred))
    return line if line.error < CLEAR * curve.error and _is_sampled(problem, joint, line.slow) else curve


def _is_sampled(problem: Problem, joint: int, slow: float) -> bool:
    """Whether half of the reversals or more have a sample with |v| ≤ ε: else single samples decide on the form of s."""
    entered = jumped = 0
    for piece in problem.fit:
        side = np.where(np.abs(piece.v[:, joint]) > slow, np.sign(piece.v[:, joint]), 0.0)
        entered += np.count_nonzero((side[1:] == 0.0) & (side[:-1] != 0.0))
        jumped += np.count_nonzero(side[1:] * side[:-1] < 0.0)
    return bool(entered >= jumped)


def _refined(error: Callable[[float, bool], float], sign: SignFit, widest: float) -> SignFit:
    """The same form with the best ε around."""
    around = (np.log(sign.slow / STEP), np.log(min(STEP * sign.slow, widest)))
    found = minimize_scalar(
        lambda x: error(float(np.exp(x)), sign.straight), bounds=around, method="bounded", options={"xatol": FINE}
    )
    better = SignFit(float(np.exp(found.x)), sign.straight, float(found.fun))
    return better if better.error < sign.error else sign


def _errors(problem: Problem, joint: int) -> tuple[Callable[[float, bool], float], float]:
    """Squared error that a joint keeps after inertia, offset, spring, gain and friction by some s(v), and without s."""
    pieces = spread_evenly(problem.fit, MOST_SAMPLES)
    weights = [p.counts[:, [joint]] for p in pieces]

    def reduced(columns: Callable[[Segment], np.ndarray]) -> np.ndarray:
        return np.concatenate([problem.reduce(p, columns(p)) * w for p, w in zip(pieces, weights, strict=True)])

    known = reduced(lambda p: _columns(p, joint))
    target = np.concatenate([problem.residual(p)[:, [joint]] * w for p, w in zip(pieces, weights, strict=True)])

    def error(slow: float, straight: bool) -> float:
        sign = reduced(lambda p: blurred_sign(p.v[:, [joint]], slow, straight))
        return _squared_error(np.hstack([known, sign]), target)

    return error, _squared_error(known, target)


def _columns(piece: Segment, joint: int) -> np.ndarray:
    v = piece.v[:, joint]
    motion = (v, v * np.abs(v), piece.a[:, joint], piece.q[:, joint])
    return np.column_stack([*motion, piece.load[:, joint], np.ones_like(v)])


def _squared_error(table: np.ndarray, target: np.ndarray) -> float:
    fitted, *_ = np.linalg.lstsq(table, target, rcond=1e-10)
    return float(np.sum((target - table @ fitted) ** 2))
