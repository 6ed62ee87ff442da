"""A servo arm that PyBullet moves: servo laws computed outside of the engine, applied as joint torques at its step.

Dry friction is the engine's own joint motor, which asks for speed zero with a bounded torque. A motor that is apart
from its link is integrated here, with its friction; the engine's joint feels the torque that passes between them.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pybullet
from pybullet_utils.bullet_client import BulletClient

from validation.motion_concealed.causes import (
    YIELDING,
    Cause,
    dry_friction,
    error_felt,
    law_with,
    torque_beside,
)
from validation.motion_concealed.mujoco_plant import STEP, spring_damping
from validation.motion_concealed.robots import write_urdf

STOPS = 2000.0  # [N m/rad] stiffness of the ends of a play: 1 N m presses them by a third of an encoder step
GRAVITY = -9.81


class BulletPlant:
    """The arm with its servos; encoders as recorded.

    Args:
        robot: the nominal one; kind: of its links; folder: for the file that the engine reads.
        law: of every servo; a motor of its own has its rotor, the others none.
        cause: what is hidden.
    """

    def __init__(self, robot: Any, kind: str, law: dict[str, float], cause: Cause | None, folder: Path):
        self.cause, self.n = cause, robot.n_dof
        self.laws = [law_with(law, cause, j) for j in range(self.n)]
        self.kp, self.kd, self.viscous = (np.array([x[k] for x in self.laws]) for k in ("kp", "kd", "viscous"))
        more = cause.value if cause is not None and cause.effect == "payload" else 0.0
        self.engine = BulletClient(pybullet.DIRECT)
        self.engine.setGravity(0, 0, GRAVITY)
        self.engine.setTimeStep(STEP)
        flags = pybullet.URDF_USE_INERTIA_FROM_FILE
        path = write_urdf(kind, folder / "plant.urdf", more)
        self.body = self.engine.loadURDF(str(path), useFixedBase=True, flags=flags)
        self.motor = None
        if cause is not None and cause.effect in YIELDING:
            self.motor = _Motor(cause, self.laws[cause.joint])
        self.joints = list(range(self.n))
        for j in self.joints:
            self.engine.changeDynamics(self.body, j, linearDamping=0, angularDamping=0, jointDamping=0)
            apart = self.motor is not None and cause is not None and j == cause.joint
            self._brake(j, 0.0 if apart else self.laws[j]["coulomb"])

    def start(self, q: np.ndarray) -> None:
        """At rest, joints at positions of shape (dof,)."""
        for j in self.joints:
            self.engine.resetJointState(self.body, j, float(q[j]), 0.0)
        if self.motor is not None and self.cause is not None:
            self.motor.angle = float(q[self.cause.joint])

    def seen(self) -> np.ndarray:
        """What the encoders show, shape (dof,) [rad]."""
        q = self._state()[0]
        if self.motor is not None and self.cause is not None and self.cause.side == "motor":
            q[self.cause.joint] = self.motor.angle
        return q

    def advance(self, asked: np.ndarray, at: float, time: float) -> None:
        """One step under commands of shape (dof,); at: share of the recording, time: since its start [s]."""
        q, v = self._state()
        torque = self.kp * (asked - q) - (self.kd + self.viscous) * v
        if (cause := self.cause) is not None:
            j, law = cause.joint, self.laws[cause.joint]
            if self.motor is not None:
                torque[j] = self.motor.pull(float(asked[j]), float(q[j]), float(v[j]))
            else:
                error = error_felt(cause, float(asked[j]), float(q[j]), at)
                torque[j] = law["kp"] * error - (law["kd"] + law["viscous"]) * v[j]
                torque[j] += torque_beside(cause, float(q[j]), time)
                if cause.effect == "static_friction":
                    self._brake(j, dry_friction(cause, law, j, float(v[j])))
        control = pybullet.TORQUE_CONTROL
        self.engine.setJointMotorControlArray(self.body, self.joints, control, forces=torque.tolist())
        self.engine.stepSimulation()

    def close(self) -> None:
        """Gives the engine back."""
        self.engine.disconnect()

    def _state(self) -> tuple[np.ndarray, np.ndarray]:
        states = self.engine.getJointStates(self.body, self.joints)
        return np.array([s[0] for s in states]), np.array([s[1] for s in states])

    def _brake(self, joint: int, friction: float) -> None:
        mode = pybullet.VELOCITY_CONTROL
        self.engine.setJointMotorControl2(self.body, joint, mode, targetVelocity=0.0, force=friction)


class _Motor:
    """A motor with its rotor and friction, joined to a link by a spring or by a play."""

    def __init__(self, cause: Cause, law: dict[str, float]):
        self.cause, self.law, self.angle, self.speed = cause, law, 0.0, 0.0
        self.stiffness, self.gap = (cause.value, 0.0) if cause.effect == "joint_elasticity" else (STOPS, cause.value)
        rotor = law["rotor"]
        soft = self.gap == 0.0
        self.damping = spring_damping(self.stiffness, rotor) if soft else float(np.sqrt(2.0 * STOPS * rotor))

    def pull(self, asked: float, q: float, v: float) -> float:
        """Torque on the link; moves the motor by one step under that torque and its servo."""
        twist, law = self.angle - q, self.law
        beyond = float(np.sign(twist)) * max(abs(twist) - self.gap, 0.0)
        passed = 0.0
        if beyond != 0.0:
            passed = self.stiffness * beyond + self.damping * (self.speed - v)
            if self.gap > 0.0 and passed * beyond < 0.0:
                passed = 0.0  # stops push and do not pull
        at, speed = (q, v) if self.cause.side == "link" else (self.angle, self.speed)
        torque = law["kp"] * (asked - at) - law["kd"] * speed - law["viscous"] * self.speed - passed
        free, dry = law["rotor"] * self.speed + STEP * torque, STEP * law["coulomb"]
        self.speed = 0.0 if abs(free) <= dry else (free - float(np.sign(free)) * dry) / law["rotor"]
        self.angle += STEP * self.speed
        return passed
