"""Pinocchio over many samples: one tight loop a quantity, its own workspace a call, so that threads may share a model.

All take and give arrays of float64, batch first: q, v, a, tau of shape (n, dof).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from lagnet.rigid_body.untyped_pinocchio import Model, pin

TIP_WRENCH = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED


def as_rows(n_dof: int, **arrays: np.ndarray) -> list[np.ndarray]:
    """Arrays as contiguous float64 of one shape (n, dof).

    Raises:
        ValueError: an array has another shape; it is called by its name.
    """
    found = {name: np.ascontiguousarray(array, dtype=np.float64) for name, array in arrays.items()}
    n = len(next(iter(found.values()))) if next(iter(found.values())).ndim else 0
    for name, array in found.items():
        if array.shape != (n, n_dof):
            expected = f"(n_samples, {n_dof})" if array.ndim != 2 else f"({n}, {n_dof})"
            raise ValueError(f"{name} has shape {array.shape}, expected {expected}: one row a sample")
    return list(found.values())


def inverse_dynamics(model: Model, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Recursive Newton–Euler, shape (n, dof); the loop over samples is Pinocchio's own, on one thread."""
    if not len(q):
        return np.empty(q.shape)
    torque = pin.rneaInParallel(1, pin.ModelPool(model, 1), *(np.asfortranarray(x.T) for x in (q, v, a)))
    return np.ascontiguousarray(torque.reshape(model.nv, len(q)).T)  # one joint or one sample comes back flat


def torque_derivatives(model: Model, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
    """∂τ/∂q, ∂τ/∂v and ∂τ/∂a of the recursive Newton–Euler algorithm, shape (3, n, dof, dof)."""
    data, derivatives = model.createData(), pin.computeRNEADerivatives
    out = np.empty((3, len(q), model.nv, model.nv))
    for i in range(len(q)):
        out[0, i], out[1, i], out[2, i] = derivatives(model, data, q[i], v[i], a[i])
    return out


def gravity_torque(model: Model, q: np.ndarray) -> np.ndarray:
    """Torque that holds the arm still, shape (n, dof)."""
    data, gravity, out = model.createData(), pin.computeGeneralizedGravity, np.empty(q.shape)
    for i in range(len(q)):
        out[i] = gravity(model, data, q[i])
    return out


def coriolis_torque(weightless: Model, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Newton–Euler without gravity and acceleration, shape (n, dof); the model must have its gravity set to zero."""
    data, bias, out = weightless.createData(), pin.nonLinearEffects, np.empty(q.shape)
    for i in range(len(q)):
        out[i] = bias(weightless, data, q[i], v[i])
    return out


def forward_dynamics(model: Model, q: np.ndarray, v: np.ndarray, tau: np.ndarray) -> np.ndarray:
    """Articulated-body algorithm, shape (n, dof)."""
    data, aba, out = model.createData(), pin.aba, np.empty(q.shape)
    for i in range(len(q)):
        out[i] = aba(model, data, q[i], v[i], tau[i])
    return out


def mass_matrix(model: Model, q: np.ndarray) -> np.ndarray:
    """Composite-rigid-body algorithm, shape (n, dof, dof)."""
    data, crba = model.createData(), pin.crba
    out = np.empty((len(q), model.nv, model.nv))
    for i in range(len(q)):
        out[i] = crba(model, data, q[i])
    lower = np.tril_indices(model.nv, -1)
    out[:, lower[0], lower[1]] = out[:, lower[1], lower[0]]  # the algorithm fills the upper triangle
    return out


def coriolis_matrix(model: Model, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """C(q, v) with Ṁ = C + Cᵀ, shape (n, dof, dof)."""
    data, coriolis = model.createData(), pin.computeCoriolisMatrix
    out = np.empty((len(q), model.nv, model.nv))
    for i in range(len(q)):
        out[i] = coriolis(model, data, q[i], v[i])
    return out


def regressor(model: Model, columns: slice, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Columns of the joint torque regressor, shape (n, dof, number of columns)."""
    data, compute, shape = model.createData(), pin.computeJointTorqueRegressor, (model.nv, 10 * model.nv)
    out = np.empty((len(q), model.nv, len(range(*columns.indices(10 * model.nv)))))
    for i in range(len(q)):
        out[i] = compute(model, data, q[i], v[i], a[i]).reshape(shape)[:, columns]  # one joint comes back flat
    return out


def weight_regressor(model: Model, joint: int, q: np.ndarray) -> np.ndarray:
    """-(m v_i + ω_i × s)·e_k of the body behind a joint, shape (3, n, dof, 10): its weight in a field along each axis.

    v_i and ω_i are the columns of the Jacobian at the base's origin, s = m p + R h the first moment about it of a body
    with mass m and first moment h in the joint's frame, at p and turned by R. Inertia has no weight.
    """
    data, frames = model.createData(), pin.computeJointJacobians
    place = data.oMi[joint + 1]
    columns, turns, origins = np.empty((len(q), 6, model.nv)), np.empty((len(q), 3, 3)), np.empty((len(q), 3))
    for i in range(len(q)):
        columns[i] = frames(model, data, q[i]).reshape(6, model.nv)
        turns[i], origins[i] = place.rotation, place.translation
    columns[:, :, [i for i in range(model.nv) if i + 1 not in model.supports[joint + 1]]] = 0.0
    moved, spun = np.moveaxis(columns[:, :3], 1, 0), np.moveaxis(columns[:, 3:], 1, 2)[:, :, None]
    out = np.zeros((3, len(q), model.nv, 10))
    out[..., 0] = -moved - np.moveaxis(np.cross(spun[:, :, 0], origins[:, None]), 2, 0)
    out[..., 1:4] = -np.moveaxis(np.cross(spun, np.moveaxis(turns, 1, 2)[:, None]), 3, 0)
    return out


def tip_jacobian(model: Model, frame: int, q: np.ndarray) -> np.ndarray:
    """Velocity of a frame per joint velocity, axes of the base, shape (n, 6, dof)."""
    data, jacobian = model.createData(), pin.computeFrameJacobian
    out = np.empty((len(q), 6, model.nv))
    for i in range(len(q)):
        out[i] = jacobian(model, data, q[i], frame, TIP_WRENCH).reshape(6, model.nv)
    return out


def orientation(model: Model, joint: int, q: np.ndarray) -> np.ndarray:
    """Axes of the frame behind a joint as columns in the axes of the base, shape (n, 3, 3)."""
    data, place, out = model.createData(), pin.forwardKinematics, np.empty((len(q), 3, 3))
    for i in range(len(q)):
        place(model, data, q[i])
        out[i] = data.oMi[joint].rotation
    return out


def energy(compute: Callable, model: Model, *motion: np.ndarray) -> np.ndarray:
    """An energy by the given Pinocchio call, shape (n,)."""
    data = model.createData()
    return np.array([compute(model, data, *row) for row in zip(*motion, strict=True)], dtype=float)
