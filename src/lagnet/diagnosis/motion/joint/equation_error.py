"""Equation error: the command error of smoothed motion as a linear sum of load, v, sign v and a.

    γ (u(t − T) − q − δ) = (load + M_ii a)/kp + [f + κ |load|] sign(v) + t_v v + m a        while the joint moves

with the gains γ of a recording over those of the law.

Non-negative least squares for each of a few delays T. It starts the fit of rollouts and is no estimate: smoothing and
quantisation bias it. Source: Gautier & Janot 2013 (equation error and output error).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import lsq_linear

from lagnet.rollout.one_joint import JointSeries
from lagnet.servos.parameters import law_vector

DELAYS = np.arange(0.0, 0.11, 0.01)  # [s] T
MOST = 20000  # samples used
SHARE = 0.05  # least share of the squared error that the load explains
DETERMINED = 4.0  # least 1/kp over its standard error, which is over blocks


@dataclass(frozen=True, eq=False)
class FirstLaw:
    """A law of which the loads determine the scale in N m, or not.

    Args:
        law: shape (len(LAW),).
        scale_is_set: whether kp is determined.
        scale_is_likely: whether the loads explain a share of the error, determined or not; else kp is `reference`.
    """

    law: np.ndarray
    scale_is_set: bool
    scale_is_likely: bool


def first_law(
    series: JointSeries, speed: np.ndarray, acceleration: np.ndarray, moving: np.ndarray, reference: float
) -> FirstLaw:
    """argmin of the squared equation error over the law of one joint and T.

    Args:
        series: of the joint.
        speed, acceleration: smoothed, shape (n,).
        moving: shape (n,), mask of samples in motion.
        reference: kp of a law whose scale nothing determines [N m/rad].
    """
    rows = np.flatnonzero(moving & (series.enabled > 0.5))
    if rows.size < 20:
        return FirstLaw(law_vector(kp=reference), False, False)
    rows = rows[:: max(1, rows.size // MOST)]
    clock = _unbroken(series.time)
    load, direction, v, a = series.load[rows], np.sign(speed[rows]), speed[rows], acceleration[rows]
    columns = np.column_stack(
        [load + series.mass[rows] * a, direction, direction * np.abs(load), v, a, series.gain[rows]]
    )  # 1/kp, f, κ, t_v, m, δ
    best = None
    for delay in DELAYS:
        error = series.gain[rows] * (np.interp(clock[rows] - delay, clock, series.command) - series.q[rows])
        x, cost = _bounded(columns, error)
        if best is None or cost < best[0]:
            best = (cost, delay, x, error)
    assert best is not None
    _, delay, x, error = best
    set_by_load = _is_determined(columns, error, x)
    likely = x[0] > 0.0 and _share_of_load(columns, error, x) > SHARE
    kp = 1.0 / x[0] if likely else reference
    law = law_vector(
        kp=kp, coulomb=x[1] * kp, load_driving=x[2] * kp, load_driven=x[2] * kp, viscous=x[3] * kp, rotor=x[4] * kp
    )
    law_delayed = law_vector(delay=float(delay), bias=float(x[5]))
    return FirstLaw(np.where(law_delayed != law_vector(), law_delayed, law), set_by_load, likely)


def _unbroken(time: np.ndarray) -> np.ndarray:
    """A clock on which several recordings follow each other a second apart."""
    back = np.diff(time, prepend=time[0]) < 0.0
    jumps = np.where(back, np.append(0.0, time[:-1] - time[1:]) + 1.0, 0.0)
    return time + np.cumsum(jumps)


def _bounded(columns: np.ndarray, error: np.ndarray) -> tuple[np.ndarray, float]:
    """Least squares with all but the last coefficient not negative, and half its squared residual."""
    sizes = np.sqrt(np.mean(columns**2, axis=0)) + 1e-300
    lower = np.append(np.zeros(columns.shape[1] - 1), -np.inf)
    found = lsq_linear(columns / sizes, error, (lower, np.inf), method="bvls")
    return found.x / sizes, float(found.cost)


def _share_of_load(columns: np.ndarray, error: np.ndarray, x: np.ndarray) -> float:
    """Share of the squared error that is left without the load and explained with it."""
    rest, without = error - columns @ x, _bounded(np.delete(columns, 0, 1), error)[1]
    return 1.0 - 0.5 * float(rest @ rest) / max(without, 1e-300)


def _is_determined(columns: np.ndarray, error: np.ndarray, x: np.ndarray, n_blocks: int = 20) -> bool:
    """Whether the load explains a share of the error, and alike in the blocks of the motion."""
    if x[0] <= 0.0 or _share_of_load(columns, error, x) < SHARE:
        return False
    rest = error - columns @ x
    sizes = np.sqrt(np.mean(columns**2, axis=0)) + 1e-300
    scaled = columns / sizes
    normal = scaled.T @ scaled + 1e-9 * len(rest) * np.eye(len(x))
    blocks = zip(np.array_split(scaled, n_blocks), np.array_split(rest, n_blocks), strict=True)
    scores = np.array([c.T @ r for c, r in blocks])
    inverse = np.linalg.inv(normal)
    spread = float(np.sqrt((inverse @ (scores.T @ scores) @ inverse)[0, 0]))
    return bool(x[0] * sizes[0] > DETERMINED * spread)
