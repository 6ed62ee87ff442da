"""The constants of an arm's rigid bodies as plain arrays, for compiled code that cannot call Pinocchio."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.rigid_body.robot import Robot
from lagnet.rigid_body.untyped_pinocchio import Model, pin


@dataclass(frozen=True, eq=False)
class KinematicTree:
    """Joints and bodies of a fixed-base tree of one-degree-of-freedom joints.

    Args:
        parents: shape (dof,), index of the joint before, -1 for the base.
        rotations: shape (dof, 3, 3), axes of the joint's frame at q = 0 as columns in the frame of the joint before.
        translations: shape (dof, 3), origin of the joint's frame in the frame of the joint before [m].
        axes: shape (dof, 3), unit axis of motion in the joint's frame.
        sliding: shape (dof,), whether the joint is prismatic.
        bodies: shape (dof, 10), inertial parameters about the joint's origin in the order of the torque regressor.
        armature: shape (dof,), rotor inertia felt at the joint [kg m²].
        gravity: shape (3,), in the frame of the base [m/s²].
    """

    parents: np.ndarray
    rotations: np.ndarray
    translations: np.ndarray
    axes: np.ndarray
    sliding: np.ndarray
    bodies: np.ndarray
    armature: np.ndarray
    gravity: np.ndarray

    def arrays(self) -> tuple[np.ndarray, ...]:
        """The fields in their order, as compiled functions take them."""
        names = ("parents", "rotations", "translations", "axes", "sliding", "bodies", "armature", "gravity")
        return tuple(np.ascontiguousarray(getattr(self, name)) for name in names)


def kinematic_tree(robot: Robot) -> KinematicTree:
    """Joint placements, axes and inertial parameters of a robot, shape as in `KinematicTree`."""
    model = robot._model
    placements = [model.jointPlacements[i] for i in range(1, model.njoints)]
    motions = _motion_axes(model)
    sliding = np.array([kind == "prismatic" for kind in robot.joint_types])
    return KinematicTree(
        parents=np.array(robot.parents, dtype=np.int64),
        rotations=np.array([p.rotation for p in placements]),
        translations=np.array([p.translation for p in placements]),
        axes=np.where(sliding[:, None], motions[:, :3], motions[:, 3:]),
        sliding=sliding,
        bodies=np.array(robot.inertial_parameters()),
        armature=np.array(robot.armature),
        gravity=np.array(robot.gravity),
    )


def _motion_axes(model: Model) -> np.ndarray:
    """Linear and angular velocity of each joint's frame at unit speed of that joint, shape (dof, 6), in that frame."""
    data = model.createData()
    pin.computeJointJacobians(model, data, pin.neutral(model))
    jacobians = [pin.getJointJacobian(model, data, i, pin.LOCAL).reshape(6, model.nv) for i in range(1, model.njoints)]
    return np.array([jacobian[:, i] for i, jacobian in enumerate(jacobians)])
