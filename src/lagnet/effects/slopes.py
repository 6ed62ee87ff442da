"""How a model's torque changes with the motion of one joint, to first order: several laws of transmissions share it.

Derivatives of Newton–Euler where the model is a robot, at a fourth of the cost of differences; else differences.
"""

from __future__ import annotations

import numpy as np

from lagnet.effects.motion import Motion
from lagnet.effects.shifted import shifted_torque
from lagnet.rigid_body.robot import Robot

ANGLE = 1e-3  # [rad], step of a central difference
SPEED = 1e-6  # [rad/s], step of a forward difference; torque is a square of speeds


def per_angle(motion: Motion, joint: int) -> np.ndarray:
    """∂τ/∂q_j, shape (n, dof)."""
    return _slopes(motion, joint)[0]


def per_speed(motion: Motion, joint: int) -> np.ndarray:
    """∂τ/∂v_j, shape (n, dof)."""
    return _slopes(motion, joint)[1]


def per_acceleration(motion: Motion, joint: int) -> np.ndarray:
    """∂τ/∂a_j, the joint's column of the mass matrix, shape (n, dof)."""
    return _slopes(motion, joint)[2]


def first_order(motion: Motion, joint: int, dq: np.ndarray, dv: np.ndarray, da: np.ndarray) -> np.ndarray:
    """dq ∂τ/∂q_j + dv ∂τ/∂v_j + da ∂τ/∂a_j, shape (n, dof) [N m]."""
    return np.einsum("kn,knj->nj", np.array((dq, dv, da)), _slopes(motion, joint))


def _slopes(motion: Motion, joint: int) -> np.ndarray:
    """∂τ/∂q_j, ∂τ/∂v_j and ∂τ/∂a_j, shape (3, n, dof)."""
    model = motion.model
    if not isinstance(model, Robot):
        return motion.remembered(("torque slopes", joint), lambda: _differences(motion, joint))

    def of_all_joints() -> np.ndarray:
        return np.ascontiguousarray(np.moveaxis(model.torque_derivatives(motion.q, motion.v, motion.a), 3, 0))

    return motion.remembered("torque slopes", of_all_joints)[joint]


def _differences(motion: Motion, joint: int) -> np.ndarray:
    none, one = np.zeros_like(motion.time), np.ones_like(motion.time)
    ahead, behind = (shifted_torque(motion, joint, sign * ANGLE * one) for sign in (1.0, -1.0))
    speed = shifted_torque(motion, joint, none, dv=SPEED * one) / SPEED
    return np.array([(ahead - behind) / (2.0 * ANGLE), speed, shifted_torque(motion, joint, none, da=one)])
