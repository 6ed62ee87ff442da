"""A controller for round trips: feed-forward of the nominal bodies and feedback, on a clock of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from lagnet.types import InverseDynamics, JointVector, Samples, Trajectory


class MovingArm(Protocol):
    """What a controller drives: an engine, or the forward motion of a corrected model."""

    def read(self) -> tuple[JointVector, JointVector]:
        """Encoder positions and speeds, shape (dof,) [rad, rad/s]."""
        ...

    def advance(self, torque: JointVector, seconds: float) -> None:
        """Let time pass under a commanded torque, as a log would hold it [N m]."""
        ...


@dataclass(frozen=True, eq=False)
class TrackingControl:
    """τ = τ_model(q_d, v_d, a_d) + k_p (q_d − q) + k_d (v_d − v), held for one period.

    Args:
        time: shape (n,), even clock of the controller [s].
        feed_forward: shape (n, dof), torque of the model that the controller knows [N m].
        q, v: shape (n, dof), wanted motion [rad, rad/s].
        kp, kd: shape (dof,), [N m/rad], [N m s/rad].
    """

    time: Samples
    feed_forward: Trajectory
    q: Trajectory
    v: Trajectory
    kp: JointVector
    kd: JointVector

    def torque(self, k: int, q: JointVector, v: JointVector) -> JointVector:
        """Torque of period k, shape (dof,) [N m]."""
        return self.feed_forward[k] + self.kp * (self.q[k] - q) + self.kd * (self.v[k] - v)

    def run(self, arm: MovingArm, watch: Callable[[int], None] | None = None) -> tuple[Trajectory, Trajectory]:
        """Drive an arm to the end; positions and torques at the start of each period, shape (n, dof).

        Args:
            watch: called after every period with its index.
        """
        step = float(self.time[1] - self.time[0])
        positions, torques = np.empty_like(self.q), np.empty_like(self.q)
        for k in range(self.time.size):
            q, v = arm.read()
            torque = self.torque(k, q, v)
            positions[k], torques[k] = q, torque
            arm.advance(torque, step)
            if watch is not None:
                watch(k)
        return positions, torques


def tracking(
    model: InverseDynamics, time: Samples, motion: tuple[Trajectory, ...], bandwidth: float
) -> TrackingControl:
    """Control of a wanted motion with feedback of a bandwidth [rad/s], from the inertia of a model."""
    q, v, a = motion
    inertia = np.mean(np.diagonal(model.mass_matrix(q[:: max(1, len(q) // 50)]), axis1=1, axis2=2), axis=0)
    return TrackingControl(
        time, model.inverse_dynamics(q, v, a), q, v, inertia * bandwidth**2, 2.0 * inertia * bandwidth
    )
