"""What to record to tell parameter sets apart where these recordings do not: poses to hold and joints to swing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.comparison.resolution import Resolution
from lagnet.rigid_body.robot import Robot

POSES = 400
WIDEST = np.pi  # [rad] where a joint has no limits
SWING = 5.0  # [rad/s²], an acceleration that most arms reach
DISTINCT = 1.0  # times the noise: a difference that a few seconds of recording show


@dataclass(frozen=True)
class Advice:
    """One way to tell two sets apart.

    Args:
        parameter: the base parameter in question.
        spread: difference between the sets, in its own unit.
        motion: 'hold' or 'swing'.
        joint: joint whose torque differs, and which swings.
        pose: pose to hold or to swing about [rad].
        difference: torque by which the sets differ there [N m].
        noise: what the best set leaves on that joint now [N m].
    """

    parameter: str
    spread: float
    motion: str
    joint: str
    pose: tuple[float, ...]
    difference: float
    noise: float

    @property
    def is_enough(self) -> bool:
        """Whether the difference stands out of the noise."""
        return self.difference > DISTINCT * self.noise

    def words(self) -> str:
        """One sentence."""
        pose = ", ".join(f"{x:.2f}" for x in self.pose)
        act = "hold still" if self.motion == "hold" else f"swing {self.joint} at {SWING:g} rad/s²"
        against = f"{self.difference:.3g} N m on {self.joint}, noise {self.noise:.2g} N m"
        if not self.is_enough:
            return (
                f"{self.parameter}: the sets differ by at most {against}: no motion of a few seconds tells them apart"
            )
        return f"{self.parameter}: {act} at ({pose}) rad: the sets differ by {against}"


def advice(robot: Robot, found: Resolution, noise: np.ndarray, seed: int = 0) -> tuple[Advice, ...]:
    """For every difference that stays open, the pose or swing that shows it best.

    Args:
        robot: kinematics and limits.
        found: base parameters of the sets.
        noise: shape (dof,), what the best set leaves [N m].
        seed: of the poses that are tried.
    """
    rng = np.random.default_rng(seed)
    lower = np.where(np.isfinite(robot.position_lower), robot.position_lower, -WIDEST)
    upper = np.where(np.isfinite(robot.position_upper), robot.position_upper, WIDEST)
    q = rng.uniform(0.9 * lower, 0.9 * upper, (POSES, robot.n_dof))
    still = np.zeros_like(q)
    tables = {"hold": [found.base.reduce(robot.joint_torque_regressor(q, still, still))]}
    tables["swing"] = [
        found.base.reduce(robot.joint_torque_regressor(q, still, np.broadcast_to(SWING * e, q.shape)))
        - tables["hold"][0]
        for e in np.eye(robot.n_dof)
    ]
    out = [_best(robot, found, int(k), tables, q, noise) for k in found.open]
    return tuple(sorted(out, key=lambda a: -a.difference / max(a.noise, 1e-300)))


def _best(
    robot: Robot, found: Resolution, k: int, tables: dict[str, list[np.ndarray]], q: np.ndarray, noise: np.ndarray
) -> Advice:
    best: Advice | None = None
    for motion, group in tables.items():
        for swung, table in enumerate(group):
            difference = np.abs(table[:, :, k]) * found.spread[k]
            at, joint = np.unravel_index(np.argmax(difference / np.maximum(noise, 1e-300)), difference.shape)
            if motion == "swing":  # the joint that swings is the one to listen to
                joint, at = swung, int(np.argmax(difference[:, swung]))
            one = Advice(
                found.names[k],
                float(found.spread[k]),
                motion,
                robot.joints[int(joint)],
                tuple(float(x) for x in q[int(at)]),
                float(difference[int(at), int(joint)]),
                float(noise[int(joint)]),
            )
            if best is None or one.difference / max(one.noise, 1e-300) > best.difference / max(best.noise, 1e-300):
                best = one
    assert best is not None
    return best
