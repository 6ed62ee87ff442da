"""Finds signals in degrees or millimetres by comparing them with joint limits and with each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.errors import RecordingError

DEGREE = np.pi / 180
FAR = np.pi  # [rad] beyond the limits: no calibration offset explains it
UNLIMITED = 4 * np.pi  # [rad] two turns to either side: what position-controlled revolute joints reach at most
MANY_DEGREES = 1080.0  # three turns in degrees; numbers beyond are no joint angles in degrees either
BUSY = 0.95  # the quantile of |q| that is judged, so that one bad sample is not taken for a unit


@dataclass(frozen=True)
class JointRanges:
    """What is known of the joints' travel.

    Args:
        lower: shape (dof,), [rad] or [m], -inf where unlimited.
        upper: shape (dof,), [rad] or [m], inf where unlimited.
        types: revolute, continuous, prismatic, or unknown, one a joint.
    """

    lower: np.ndarray
    upper: np.ndarray
    types: tuple[str, ...]

    def reach(self, joint: int) -> float:
        """Largest |q| inside the limits; inf where unlimited, or where a robot file left them at zero."""
        if not self.lower[joint] < self.upper[joint]:
            return float("inf")
        return float(max(abs(self.lower[joint]), abs(self.upper[joint])))


def unknown_ranges(n_dof: int) -> JointRanges:
    """Nothing is known of the joints."""
    return JointRanges(np.full(n_dof, -np.inf), np.full(n_dof, np.inf), ("unknown",) * n_dof)


def refuse_degrees(q: np.ndarray, ranges: JointRanges, joints: tuple[str, ...], stated: np.ndarray, where: str) -> None:
    """Positions far outside the limits are in another unit.

    Args:
        q: shape (n, dof), positions as rad or m.
        stated: shape (dof,), True where the user stated the unit.

    Raises:
        RecordingError: names the joint, its range and the scale that would mend it.
    """
    for j, joint in enumerate(joints):
        if stated[j]:
            continue
        size, reach, kind = float(np.quantile(np.abs(q[:, j]), BUSY)), ranges.reach(j), ranges.types[j]
        if kind == "prismatic" and np.isfinite(reach) and size > 20 * max(reach, 0.05):
            raise _refusal(j, joint, size, reach, "m", "millimetres", 0.001, where)
        if kind in ("revolute", "unknown") and np.isfinite(reach) and size > reach + FAR:
            raise _refusal(j, joint, size, reach, "rad", "degrees", DEGREE, where)
        if kind in ("revolute", "unknown") and not np.isfinite(reach) and UNLIMITED < size < MANY_DEGREES:
            raise _refusal(j, joint, size, reach, "rad", "degrees", DEGREE, where)


def refuse_degrees_per_second(
    time: np.ndarray, index: np.ndarray, q: np.ndarray, v: np.ndarray, joints: tuple[str, ...], where: str
) -> None:
    """Velocities must integrate to the positions; 57 times too much is degrees per second.

    Args:
        time: shape (n,), [s].
        index: shape (n,), motion of each sample.
        q, v: shape (n, dof), positions [rad] and velocities [rad/s].

    Raises:
        RecordingError: names the joint and the scale that would mend it.
    """
    inside = np.diff(index) == 0
    if not inside.any():
        return
    moved = np.diff(q, axis=0)[inside]
    travelled = (0.5 * (v[1:] + v[:-1]) * np.diff(time)[:, None])[inside]
    slope = np.sum(moved * travelled, axis=0) / np.maximum(np.sum(travelled**2, axis=0), 1e-300)
    unlike = np.sum((moved - slope * travelled) ** 2, axis=0) / np.maximum(np.sum(moved**2, axis=0), 1e-300)
    for j in np.flatnonzero((np.abs(slope / DEGREE - 1) < 0.2) & (unlike < 0.5)):
        raise RecordingError(
            f"v_{j} ({joints[j]}) is {1 / slope[j]:.3g} times the rate at which q_{j} changes: degrees per second?",
            where=where,
            next_step='convert to rad/s, or give --columns with [scale] "v" = 0.0174533',
        )


def _refusal(
    j: int, joint: str, size: float, reach: float, unit: str, foreign: str, factor: float, where: str
) -> RecordingError:
    limits = f"its limits (±{reach:.3g} {unit})" if np.isfinite(reach) else "what a revolute joint reaches"
    return RecordingError(
        f"q_{j} ({joint}) goes to {size:.4g}, far outside {limits}: {foreign} instead of {unit}?",
        where=where,
        next_step=f'convert to {unit}, or give --columns with [scale] "q_{j}" = {factor:.7g}'
        + (' (or "q" for all joints)' if unit == "rad" else "")
        + ", or = 1 if the numbers are right",
    )
