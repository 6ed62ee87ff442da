"""Y(q, v, a) Δπ: torque of a change of inertial parameters, without the regressor where Newton–Euler will do."""

from __future__ import annotations

import numpy as np

from lagnet.rigid_body.inertia import is_physically_consistent
from lagnet.rigid_body.robot import Robot
from lagnet.types import RigidBodyModel, Trajectory

CHUNK = 4096  # samples whose regressor is in memory at once
HEAVIER = 2.0  # times the largest change: bodies that stay bodies with it
ROUND = (4, 6, 9)  # I_xx, I_yy, I_zz among the ten parameters


def torque_of_change(
    model: RigidBodyModel, change: np.ndarray, q: Trajectory, v: Trajectory, a: Trajectory
) -> Trajectory:
    """Y(q, v, a) Δπ, shape (n, dof) [N m].

    Torque is linear in the parameters: that of real bodies is Newton–Euler of a robot that has these alone, a tenth of
    the time of the regressor. Of any other change it is the difference between heavy bodies with and without it.

    Args:
        model: a robot, or any model with a regressor.
        change: shape (dof, 10), in the order of the regressor.
        q, v, a: shape (n, dof).
    """
    if isinstance(model, Robot):
        with_it, *without = _robots_of_change(model, change)
        return with_it.inverse_dynamics(q, v, a) - sum(r.inverse_dynamics(q, v, a) for r in without)
    out = np.zeros(np.shape(q))
    for start in range(0, len(q), CHUNK):
        rows = slice(start, start + CHUNK)
        out[rows] = model.joint_torque_regressor(q[rows], v[rows], a[rows]) @ change.ravel()
    return out


def derivatives_of_change(model: Robot, change: np.ndarray, q: Trajectory, v: Trajectory, a: Trajectory) -> np.ndarray:
    """∂/∂q, ∂/∂v and ∂/∂a of Y(q, v, a) Δπ, shape (3, n, dof, dof), as `Robot.torque_derivatives`."""
    with_it, *without = _robots_of_change(model, change)
    return with_it.torque_derivatives(q, v, a) - sum(r.torque_derivatives(q, v, a) for r in without)


def _robots_of_change(model: Robot, change: np.ndarray) -> list[Robot]:
    """A robot whose torque is that of the change alone; or two of real bodies, whose difference it is."""
    arm = model.with_armature(np.zeros(model.n_dof))
    if np.all(is_physically_consistent(change[np.any(change != 0.0, axis=1)])):
        return [arm.with_inertial_parameters(change)]
    bodies = _heavy_beside(change)
    return [arm.with_inertial_parameters(p) for p in (bodies + change, bodies)]


def _heavy_beside(change: np.ndarray) -> np.ndarray:
    """Balls about the joints' origins, so heavy that with the change they stay bodies, shape (dof, 10)."""
    largest = np.max(np.abs(change), axis=0)
    bodies = np.zeros_like(change)
    bodies[:, 0] = HEAVIER * largest[0] + np.any(change[:, 1:] != 0.0)
    off_centre = np.sum(largest[1:4] ** 2) / max(bodies[0, 0] - largest[0], 1e-300)
    bodies[:, ROUND] = HEAVIER * (np.sum(largest[4:]) + off_centre)
    return bodies
