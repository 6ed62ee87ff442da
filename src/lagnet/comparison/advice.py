"""What to record to tell parameter sets apart where these recordings do not: poses to hold, joints to swing and turn.

A difference counts as enough where its torque exceeds what the best set leaves unexplained: below that, what is missing
from all sets decides more than what the sets differ by.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.comparison.differences import short
from lagnet.comparison.resolution import KINDS, Resolution
from lagnet.rigid_body.robot import Robot

POSES = 400
WIDEST = np.pi  # [rad] where a joint has no limits
SWING = 5.0  # [rad/s²], an acceleration that most arms reach
SPEED = 2.0  # [rad/s] of a joint without a limit
DISTINCT = 1.0  # times what the best set leaves unexplained


@dataclass(frozen=True)
class Advice:
    """One way to tell two sets apart.

    Args:
        parameter: the parameter in question.
        spread: difference between the sets, in its own unit.
        motion: 'hold', 'swing', 'turn' at a speed, or 'reverse' slowly.
        joint: joint whose torque differs, and which moves.
        pose: pose to hold or to move about [rad]; none where any will do.
        difference: torque by which the sets differ there [N m].
        noise: what the best set leaves on that joint now [N m].
        speed: at which the joint turns [rad/s].
    """

    parameter: str
    spread: float
    motion: str
    joint: str
    pose: tuple[float, ...]
    difference: float
    noise: float
    speed: float = 0.0

    @property
    def is_enough(self) -> bool:
        """Whether the difference stands out of what is unexplained."""
        return self.difference > DISTINCT * self.noise

    def act(self) -> str:
        """What to do."""
        about = f" at ({', '.join(f'{x:.2f}' for x in self.pose)}) rad" if self.pose else ""
        return {
            "hold": "hold still",
            "swing": f"swing {self.joint} at {SWING:g} rad/s²",
            "turn": f"turn {self.joint} both ways at {self.speed:.2g} rad/s",
            "reverse": f"turn {self.joint} slowly both ways, with stops",
        }[self.motion] + about

    def words(self) -> str:
        """One sentence."""
        if not self.is_enough:
            return (
                f"{short(self.parameter)}: the sets differ by at most {self.difference:.3g} N m on {self.joint}, less "
                f"than the {self.noise:.2g} N m that the best of them leaves unexplained: find that first "
                "(lagnet diagnose)"
            )
        return (
            f"{short(self.parameter)}: {self.act()}: the sets differ by {self.difference:.3g} N m on {self.joint}, "
            f"{self.noise:.2g} N m are unexplained there"
        )


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
    rank = found.base.rank
    out = [
        _best(robot, found, int(k), tables, q, noise) if k < rank else _beside(robot, found, int(k), noise)
        for k in found.open
    ]
    return tuple(sorted(out, key=lambda a: -a.difference / max(a.noise, 1e-300)))


def _beside(robot: Robot, found: Resolution, k: int, noise: np.ndarray) -> Advice:
    """The motion that shows friction or the rotor of one joint."""
    kind, j = found.beside[k - found.base.rank]
    speed = 0.5 * float(robot.velocity_limit[j]) if np.isfinite(robot.velocity_limit[j]) else SPEED
    motion, factor = dict(zip(KINDS, (("turn", speed), ("reverse", 1.0), ("swing", SWING)), strict=True))[kind]
    spread, joint = float(found.spread[k]), robot.joints[j]
    return Advice(found.names[k], spread, motion, joint, (), spread * factor, float(noise[j]), speed)


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
