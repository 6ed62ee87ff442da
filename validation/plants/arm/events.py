"""What happens for a while only: something pushes on the last link, or the gripper carries a load."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]

from validation.plants.arm.bodies import PinocchioBodies


@dataclass(frozen=True, eq=False)
class Push:
    """A constant force in the axes of the base on a point of one link.

    Args:
        bodies: whose kinematics carry it; joint: index of the link's joint.
        force: shape (3,), on the arm, in the axes of the base [N].
        point: shape (3,), in the frame of the joint [m].
        start, end: [s], by the clock of the run.
    """

    bodies: PinocchioBodies
    joint: int
    force: np.ndarray
    point: np.ndarray
    start: float
    end: float

    def reset(self) -> None: ...

    def add(self, t: float, q: np.ndarray, v: np.ndarray, force: np.ndarray, slope: np.ndarray) -> None:
        if not self.start <= t < self.end:
            return
        model, data = self.bodies.model, self.bodies.data
        pin.computeJointJacobians(model, data, q)
        J = pin.getJointJacobian(model, data, self.joint + 1, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)
        arm = data.oMi[self.joint + 1].rotation @ self.point
        force += J[:3].T @ self.force + J[3:].T @ np.cross(arm, self.force)


@dataclass(frozen=True, eq=False)
class Grasp:
    """Other bodies, with a load on the last link, between two times of the run [s]."""

    bodies: PinocchioBodies
    start: float
    end: float
