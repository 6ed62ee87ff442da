"""Bounds on q, v, a and τ of a suggested motion: the arm's limits with a margin, or the range of the recordings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.diagnosis.problem.problem import Problem
from lagnet.types import JointVector, Trajectory, joint_types_of

BEYOND = 0.7  # [rad] beyond the recorded range, for a joint with known limits
SLIDE = 0.1  # [m/rad] a prismatic joint's equivalent of a radian in these limits
POSITION_MARGIN = 0.05  # of the position range, kept from both ends
SPEED_SHARE = 0.7  # of the speed limit
TOP_SPEED = 1.5  # [rad/s] whatever the limit, unless the recordings were faster
EFFORT_SHARE = 0.8  # of the effort limit
ROUNDING = 1e-9  # [rad]
MODEST = 2.0  # [rad/s²] always allowed to a joint with known limits, within its effort limit
OF_OTHERS = 0.5  # of the other joints' usual acceleration, for a joint that stood still in the recordings


@dataclass(frozen=True, eq=False)
class MotionLimits:
    """Bounds of a motion, each of shape (dof,).

    Args:
        lower, upper: position [rad].
        speed: [rad/s].
        acceleration: [rad/s²].
        torque: [N m].
        from_model: whether the model states limits; else they are what the recordings show.
    """

    lower: JointVector
    upper: JointVector
    speed: JointVector
    acceleration: JointVector
    torque: JointVector
    from_model: bool

    @property
    def middle(self) -> JointVector:
        """Middle of the position range, shape (dof,)."""
        return 0.5 * (self.lower + self.upper)

    def allow(self, q: Trajectory, v: Trajectory, a: Trajectory, tau: Trajectory) -> bool:
        """Whether a motion with its torque stays inside, arrays of shape (n, dof)."""
        inside = np.all(q >= self.lower - ROUNDING) and np.all(q <= self.upper + ROUNDING)
        bounded = ((v, self.speed), (a, self.acceleration), (tau, self.torque))
        return bool(inside and all(np.all(np.abs(x) <= most) for x, most in bounded))


def motion_limits(problem: Problem) -> MotionLimits:
    """Limits of the model where it states any, with a margin and near the recorded range.

    The recorded range is always allowed. No robot description states a limit of acceleration: it is that of the
    recordings, or a modest one, and the effort limit. A model without limits, such as a learned one, has the recorded
    range of all four.
    """
    q, v, a, tau = (np.concatenate([getattr(p, name) for p in problem.fit]) for name in ("q", "v", "a", "tau"))
    lowest, highest = q.min(axis=0), q.max(axis=0)
    speed, acceleration, torque = (np.abs(x).max(axis=0) for x in (v, a, tau))
    unit = _unit(problem)
    still = acceleration < OF_OTHERS * np.median(acceleration / unit) * unit
    acceleration = np.where(still, OF_OTHERS * np.median(acceleration / unit) * unit, acceleration)
    model: Any = problem.nominal
    if not hasattr(model, "position_lower"):
        return MotionLimits(lowest, highest, speed, acceleration, torque, False)
    acceleration = np.maximum(acceleration, MODEST * unit)
    lower, upper = _positions(model, lowest, highest, unit)
    fastest = np.minimum(TOP_SPEED * unit, SPEED_SHARE * _stated(model.velocity_limit, speed / SPEED_SHARE))
    strongest = EFFORT_SHARE * _stated(model.effort_limit, torque / EFFORT_SHARE)
    return MotionLimits(lower, upper, np.maximum(fastest, speed), acceleration, np.maximum(strongest, torque), True)


def _unit(problem: Problem) -> JointVector:
    """1 for joints that turn, less for joints that slide, shape (dof,)."""
    return np.array([SLIDE if kind == "prismatic" else 1.0 for kind in joint_types_of(problem.nominal, problem.n_dof)])


def _positions(
    model: Any, lowest: JointVector, highest: JointVector, unit: JointVector
) -> tuple[JointVector, JointVector]:
    """The recorded range widened a little, inside the limits where they are known; the recorded range where not."""
    low, high = np.asarray(model.position_lower, float), np.asarray(model.position_upper, float)
    known = np.isfinite(low) & np.isfinite(high) & (low < high)
    margin = POSITION_MARGIN * np.where(known, high - low, 0.0)
    endless = np.array([kind == "continuous" for kind in model.joint_types])
    lower = np.where(known, np.maximum(low + margin, lowest - BEYOND * unit), lowest - BEYOND * unit * endless)
    upper = np.where(known, np.minimum(high - margin, highest + BEYOND * unit), highest + BEYOND * unit * endless)
    return np.minimum(lower, lowest), np.maximum(upper, highest)


def _stated(limit: Any, otherwise: JointVector) -> JointVector:
    """A limit where one is stated; a description that says zero or nothing says nothing."""
    limit = np.asarray(limit, float)
    return np.where(np.isfinite(limit) & (limit > 0.0), limit, otherwise)
