"""UR-5 in PyBullet with linear, angular and joint damping, under torque control: motion and motor torque."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import Robot
from lagnet.simulation.pybullet_arm import PyBulletArm
from validation.ideal.motion import MotionSettings, random_motion


@dataclass(frozen=True)
class Damping:
    """Arguments of PyBullet's changeDynamics, and how wanted motion is followed.

    Args:
        linear, angular: damping of every link [-]; joint: of every joint [N m s/rad].
        frequency: natural frequency of the position loop [rad/s]; rate: of the simulation [Hz]; keep: every so many
            steps a sample is kept.
    """

    linear: float = 0.1
    angular: float = 0.1
    joint: float = 0.2
    frequency: float = 15.0
    rate: float = 240.0
    keep: int = 4


def damped_motion(robot: Robot, motion: MotionSettings, seed: int, samples: int | None, damping: Damping) -> Recording:
    """Follow random motion by computed torque and record state, acceleration of the step and applied torque.

    The engine moves v by its acceleration at (q, v) over a step, so (v after − v before) / step is exact.
    """
    wanted = random_motion(robot, replace(motion, rate=damping.rate), seed)
    kept = []
    with PyBulletArm(robot, 1.0 / damping.rate) as arm:
        arm.damp(damping.linear, damping.angular, damping.joint)
        for part in wanted.parts():
            kept.append(_follow(arm, part, damping))
            if samples is not None and sum(len(k[0]) for k in kept) >= samples:
                break
    q, v, a, tau = (np.concatenate([k[i] for k in kept])[:samples] for i in range(4))
    label = np.concatenate([np.full(len(k[0]), i) for i, k in enumerate(kept)])[:samples]
    time = np.arange(len(q)) * damping.keep / damping.rate
    names = tuple(map(str, range(len(kept))))
    return Recording(time=time, q=q, v=v, a=a, tau=tau, joints=robot.joints, trajectory=label, trajectory_names=names)


def _follow(arm: PyBulletArm, wanted: Recording, damping: Damping) -> tuple[np.ndarray, ...]:
    assert wanted.v is not None
    assert wanted.a is not None
    arm.put(wanted.q[0], wanted.v[0])
    rows = []
    for i in range(len(wanted)):
        q, v = arm.state()
        error, slip = wanted.q[i] - q, wanted.v[i] - v
        a = wanted.a[i] + damping.frequency**2 * error + 2.0 * damping.frequency * slip
        tau = arm.mass_matrix(q) @ a + arm.bias_torque(q, v)
        arm.advance(tau)
        if i % damping.keep == 0:
            rows.append((q, v, (arm.state()[1] - v) * damping.rate, tau))
    return tuple(np.array(column) for column in zip(*rows, strict=True))
