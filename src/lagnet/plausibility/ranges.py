"""The motion in which a model is looked at: its recordings where there are any, else its limits, else common sense."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.recordings.recording import Recording
from lagnet.types import JointVector

TURN, STROKE = np.pi, 0.5  # half width of an unlimited joint: a whole turn [rad], a stroke of one metre [m]
SPEED, ACCELERATION = 2.0, 6.0  # what arms of metre size do [rad/s, rad/s²]; metres for prismatic joints


@dataclass(frozen=True, eq=False)
class Ranges:
    """Box of motion.

    Args:
        lower, upper: shape (dof,), positions [rad] or [m].
        velocity: shape (dof,), largest speed [rad/s] or [m/s].
        acceleration: shape (dof,), largest acceleration [rad/s²] or [m/s²].
        joint_types: 'revolute', 'continuous' or 'prismatic'.
    """

    lower: JointVector
    upper: JointVector
    velocity: JointVector
    acceleration: JointVector
    joint_types: tuple[str, ...]

    @property
    def revolute(self) -> np.ndarray:
        """Which joints turn, shape (dof,)."""
        return np.array([kind != "prismatic" for kind in self.joint_types])


def ranges_of(model: Any, reference: Any | None, recordings: Sequence[Recording]) -> Ranges:
    """The box of motion that a model is meant for.

    Joint types and limits come from the model, else from its reference; joints of unknown type are taken as revolute.
    """
    n = model.n_dof
    source = next((m for m in (model, reference) if hasattr(m, "joint_types")), None)
    kinds = tuple(source.joint_types) if source is not None else ("revolute",) * n
    turns = np.array([kind != "prismatic" for kind in kinds])
    lower, upper = _positions(model, reference, turns)
    velocity = np.minimum(_limit(model, reference, "velocity_limit", n), SPEED)
    acceleration = np.full(n, ACCELERATION)
    if recordings:
        lower, upper = _seen(recordings, lower, upper)
        velocity = _fastest(recordings, velocity)
    return Ranges(lower, upper, velocity, acceleration, kinds)


def _positions(model: Any, reference: Any | None, turns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    half = np.where(turns, TURN, STROKE)
    lower = _limit(model, reference, "position_lower", turns.size, -np.inf)
    upper = _limit(model, reference, "position_upper", turns.size)
    lower, upper = np.where(np.isfinite(lower), lower, -half), np.where(np.isfinite(upper), upper, half)
    centre, width = (lower + upper) / 2, np.minimum((upper - lower) / 2, 2 * half)
    width = np.where(width > 0, width, half)
    return centre - width, centre + width


def _limit(model: Any, reference: Any | None, name: str, n: int, absent: float = np.inf) -> np.ndarray:
    for source in (model, reference):
        values = getattr(source, name, None)
        if values is not None:
            values = np.asarray(values, dtype=float)
            return np.where((np.abs(values) > 0) | (name != "velocity_limit"), values, absent)
    return np.full(n, absent)


def _seen(recordings: Sequence[Recording], lower: np.ndarray, upper: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What the recordings went through; a joint that stood still keeps a tenth of its range around that place."""
    low = np.min([r.q.min(axis=0) for r in recordings], axis=0)
    high = np.max([r.q.max(axis=0) for r in recordings], axis=0)
    least = 0.05 * (upper - lower)
    still = high - low < 2 * least
    centre = (low + high) / 2
    return np.where(still, centre - least, low), np.where(still, centre + least, high)


def _fastest(recordings: Sequence[Recording], velocity: np.ndarray) -> np.ndarray:
    speeds = []
    for recording in recordings:
        for part in recording.parts():
            if part.v is not None:
                speeds.append(np.abs(part.v).max(axis=0))
            elif len(part) > 2:
                speeds.append(np.quantile(np.abs(np.gradient(part.q, part.time, axis=0)), 0.99, axis=0))
    if not speeds:
        return velocity
    fastest = np.max(speeds, axis=0)
    return np.where(fastest > 0.02 * velocity, fastest, velocity)
