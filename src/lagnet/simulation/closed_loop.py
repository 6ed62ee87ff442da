"""Drive an arm along a wanted motion under torque control, with injected effects acting at every step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.rigid_body.robot import Robot
from lagnet.simulation.injection import StepPhysics
from lagnet.simulation.motions import WantedMotion
from lagnet.simulation.pybullet_arm import PyBulletArm
from lagnet.simulation.stick import LEAN, friction_torque
from lagnet.types import JointVector, Samples, Trajectory


@dataclass(frozen=True)
class LoopSettings:
    """The controller: computed torque of the nominal bodies, with feedback of this bandwidth.

    Args:
        slowest, fastest: bandwidth for heavy and for light joints [rad/s].
        give: deviation by which a joint's own typical torque may move it [rad].
    """

    slowest: float = 40.0
    fastest: float = 150.0
    give: float = 0.01


@dataclass(frozen=True, eq=False)
class TrueRun:
    """What truly happened, at the engine's step; all columns of a row belong to one instant.

    Args:
        time: shape (n,), [s].
        q, v, a: shape (n, dof), motion [rad, rad/s, rad/s²].
        tau: shape (n, dof), motor torque [N m].
    """

    time: Samples
    q: Trajectory
    v: Trajectory
    a: Trajectory
    tau: Trajectory


def run_closed_loop(robot: Robot, physics: StepPhysics, wanted: WantedMotion, settings: LoopSettings) -> TrueRun:
    """Track a motion; the motor torque has to overcome the bodies and every injected effect.

    Args:
        robot: the nominal model, which the controller knows.
        physics: effects that the controller does not know.
        wanted: its clock is the engine's clock.
        settings: the controller.
    """
    step = float(wanted.time[1] - wanted.time[0])
    omega = _bandwidth(robot, wanted, settings, step)
    seen = np.empty((4, *wanted.q.shape))
    a, friction = wanted.a[0], np.zeros(robot.n_dof)
    with PyBulletArm(robot, step) as arm:
        arm.put(wanted.q[0], wanted.v[0] - step / 2 * a)
        for k in range(wanted.time.size):
            q, v = arm.state()
            M, v_now = arm.mass_matrix(q), v + step / 2 * a
            h = arm.bias_torque(q, v_now)
            pull = omega**2 * (wanted.q[k] - q) + 2 * omega * (wanted.v[k] - v_now)
            tau = h + M @ (wanted.a[k] + pull)
            a, friction = _accelerate(physics, q, v, v_now, a, M, h, tau, step, friction)
            seen[:, k] = q, v + step / 2 * a, a, tau
            arm.advance(M @ a + arm.bias_torque(q, v))
    return TrueRun(wanted.time, seen[0], seen[1], seen[2], seen[3])


def _accelerate(
    physics: StepPhysics,
    q: JointVector,
    v: JointVector,
    v_now: JointVector,
    a_before: JointVector,
    M: np.ndarray,
    h: JointVector,
    tau: JointVector,
    step: float,
    guess: JointVector,
) -> tuple[JointVector, JointVector]:
    """Acceleration over the step, and the friction in it, of bodies and effects under a motor torque."""
    r0, R = physics.body_torque(q, v_now)
    inverse = np.linalg.inv(M + R)
    a = inverse @ (tau - h - r0)
    if not physics.joints:
        return a, guess
    load = h + r0 + (M + R) @ a_before
    lean = LEAN * step
    friction = friction_torque(physics, q, v + lean * a, load, lean * inverse, guess)
    return a - inverse @ friction, friction


def _bandwidth(robot: Robot, wanted: WantedMotion, settings: LoopSettings, step: float) -> JointVector:
    every = max(1, wanted.time.size // 200)
    q, v, a = wanted.q[::every], wanted.v[::every], wanted.a[::every]
    torque = np.sqrt(np.mean(robot.inverse_dynamics(q, v, a) ** 2, axis=0))
    inertia = np.mean(np.diagonal(robot.mass_matrix(q), axis1=1, axis2=2), axis=0)
    wished = np.sqrt(torque / np.maximum(settings.give * inertia, 1e-12))
    return np.clip(wished, settings.slowest, min(settings.fastest, 0.15 / step))
