"""Pinocchio models read as plain arrays, and copied with other bodies, rotors or gravity."""

from __future__ import annotations

import numpy as np

from lagnet.rigid_body.inertia import parameters_of_body, tensor_about_com, tensor_about_origin
from lagnet.rigid_body.untyped_pinocchio import Data, Inertia, Model, pin

ROUNDED = 1e-12  # of a tensor about the origin, by which rounding takes that about the centre of mass below zero


def with_gravity(model: Model, gravity: np.ndarray) -> Model:
    """A copy mounted otherwise.

    Raises:
        ValueError: gravity is not of shape (3,), in the frame of the base [m/s²].
    """
    gravity = np.asarray(gravity, dtype=float)
    if gravity.shape != (3,):
        raise ValueError(f"gravity has shape {gravity.shape}, expected (3,)")
    model = model.copy()
    model.gravity.linear = gravity
    return model


def with_inertial_parameters(model: Model, parameters: np.ndarray) -> Model:
    """A copy with other bodies.

    Raises:
        ValueError: parameters are not of shape (dof, 10), or a body has a first moment and no mass, or a negative
            moment of inertia about its centre of mass.
    """
    parameters = np.asarray(parameters, dtype=float)
    if parameters.shape != (model.nv, 10):
        raise ValueError(f"parameters have shape {parameters.shape}, expected ({model.nv}, 10)")
    model = model.copy()
    for i, row in enumerate(parameters):
        model.inertias[i + 1] = _inertia(row)
    return model


def with_armature(model: Model, armature: np.ndarray) -> Model:
    """A copy with other rotors.

    Raises:
        ValueError: armature is not of shape (dof,), inertia felt at each joint [kg m²].
    """
    armature = np.asarray(armature, dtype=float)
    if armature.shape != (model.nv,):
        raise ValueError(f"armature has shape {armature.shape}, expected ({model.nv},)")
    model = model.copy()
    model.armature = armature
    return model


def inertial_parameters(model: Model) -> np.ndarray:
    """Ten parameters of the body behind each joint, shape (dof, 10)."""
    bodies = [model.inertias[i] for i in range(1, model.njoints)]
    return np.array([parameters_of_body(b.mass, np.array(b.lever), np.array(b.inertia)) for b in bodies])


def placed(model: Model, q: np.ndarray) -> Data:
    """Frames and Jacobians of joints in one pose.

    Raises:
        ValueError: q is not of shape (dof,).
    """
    q = np.asarray(q, dtype=float)
    if q.shape != (model.nv,):
        raise ValueError(f"q has shape {q.shape}, expected ({model.nv},): one pose")
    data = model.createData()
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    return data


def tip_frame(model: Model) -> int:
    """The frame on the last joint's body that lies farthest from it: a flange or tool frame where there is one."""
    last = model.njoints - 1
    own = [i for i, frame in enumerate(model.frames) if frame.parentJoint == last]
    return max(own, key=lambda i: round(float(np.linalg.norm(model.frames[i].placement.translation)), 9))


def frozen(values: np.ndarray) -> np.ndarray:
    """A copy that cannot be written to."""
    values = np.array(values, dtype=float)
    values.setflags(write=False)
    return values


def limit(values: np.ndarray) -> np.ndarray:
    """Limits, infinite where Pinocchio has its largest number; they cannot be written to."""
    values = np.array(values, dtype=float)
    values[np.abs(values) > 1e100] *= np.inf
    return frozen(values)


def _inertia(row: np.ndarray) -> Inertia:
    """A body from ten parameters.

    Raises:
        ValueError: first moment without mass, which no body has and Pinocchio cannot hold; or a negative moment of
            inertia about the centre of mass, beyond rounding, as that of a flat body may be.
    """
    if row[0] == 0.0:
        if row[1:4].any():
            raise ValueError("a body of zero mass has a first moment; give it a mass")
        return pin.Inertia(0.0, np.zeros(3), tensor_about_origin(row))
    least, size = np.diagonal(tensor_about_com(row)).min(), np.abs(tensor_about_origin(row)).max()
    if least < -ROUNDED * size:
        raise ValueError(f"a body has {least:.3g} kg m² about its centre of mass; no moment of inertia is negative")
    return pin.Inertia.FromDynamicParameters(row)
