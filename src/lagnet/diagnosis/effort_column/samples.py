"""A column of unknown meaning beside what a model says of the same motion, joint by joint."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.recordings.conditioning.condition import condition, motion_at_samples
from lagnet.recordings.recording import Recording
from lagnet.recordings.sampling import spread_rows
from lagnet.types import InverseDynamics

MOST = 4000  # samples that are compared
BLOCKS = 8  # stretches of time that are held out in turn
SATURATED = 0.01  # share of samples at the very same largest size, above which it is the end of a range
NARROW = 0.02  # of the fast speed: width of the sign of the velocity
STATIC = 1e-4  # [rad/s] slowest width
FAST = 95  # percentile of |v| that is called fast


@dataclass(frozen=True, eq=False)
class EffortSamples:
    """One column of every joint, and the motion.

    Args:
        y: shape (n, dof), the column as recorded.
        gravity, dynamic: shape (n, dof), nominal gravity torque and the rest of the nominal torque [N m].
        q, v, a: shape (n, dof), smoothed motion.
        error: shape (n, dof), commanded minus measured position, or None.
        block: shape (n,), stretch of time that a sample belongs to.
        joints: names.
        speed_limit: shape (dof,), of the robot, inf where unknown [rad/s].
    """

    y: np.ndarray
    gravity: np.ndarray
    dynamic: np.ndarray
    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    error: np.ndarray | None
    block: np.ndarray
    joints: tuple[str, ...]
    speed_limit: np.ndarray

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        return len(self.joints)

    def within_range(self, joint: int) -> np.ndarray:
        """Mask of samples, shape (n,), at which the column is not held at the end of its range."""
        size = np.abs(self.y[:, joint])
        at_end = size == size.max()
        return ~at_end if at_end.mean() > SATURATED and not at_end.all() else np.ones(len(size), dtype=bool)

    def sign(self, joint: int) -> np.ndarray:
        """Smoothed sign of the velocity, shape (n,)."""
        width = max(NARROW * float(np.percentile(np.abs(self.v[:, joint]), FAST)), STATIC)
        return np.tanh(self.v[:, joint] / width)


def effort_samples(
    recordings: Sequence[Recording], robot: InverseDynamics, column: str = "tau", most: int = MOST
) -> EffortSamples:
    """Lay a column beside the model's torques.

    Args:
        recordings: that hold the column.
        robot: the nominal model.
        column: "tau", "current" or another signal of a recording.
        most: samples that are compared.

    Raises:
        RecordingError: the recordings are too short to be smoothed.
    """
    with_column = [replace(r, tau=getattr(r, column)) for r in recordings]
    conditioned = condition(with_column)
    parts = []
    for index, recording in enumerate(with_column):
        rows = np.concatenate(
            [np.arange(s.first, s.last + 1) for s in conditioned.stretches if s.recording == index] or [[]]
        ).astype(int)
        motion = motion_at_samples(recording, conditioned, index)
        told = np.full_like(recording.q, np.nan) if recording.command is None else recording.command - recording.q
        parts.append([x[rows] for x in (recording.torque, *motion, told)])
    y, q, v, a, error = (np.concatenate(columns) for columns in zip(*parts, strict=True))
    n = len(y)
    block = np.minimum(np.arange(n) * BLOCKS // max(n, 1), BLOCKS - 1)
    few = spread_rows(n, most)
    y, q, v, a, error, block = (x[few] for x in (y, q, v, a, error, block))
    gravity = robot.gravity_torque(q)
    dynamic = robot.inverse_dynamics(q, v, a) - gravity
    limit = np.asarray(getattr(robot, "velocity_limit", np.full(q.shape[1], np.inf)), dtype=float)
    limit = np.where(np.isfinite(limit) & (limit > 0), limit, np.inf)
    has_error = bool(np.isfinite(error).all())
    return EffortSamples(y, gravity, dynamic, q, v, a, error if has_error else None, block, robot.joints, limit)
