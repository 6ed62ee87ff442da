"""How a model's torque changes with the motion of one joint, to first order: several laws of transmissions share it."""

from __future__ import annotations

import numpy as np

from lagnet.effects.motion import Motion
from lagnet.effects.shifted import shifted_torque

ANGLE = 1e-3  # [rad], step of a central difference
SPEED = 1e-6  # [rad/s], step of a forward difference; torque is a square of speeds


def per_angle(motion: Motion, joint: int) -> np.ndarray:
    """∂τ/∂q_j, shape (n, dof)."""

    def make() -> np.ndarray:
        step = np.full_like(motion.time, ANGLE)
        return (shifted_torque(motion, joint, step) - shifted_torque(motion, joint, -step)) / (2.0 * ANGLE)

    return motion.remembered(f"torque per angle of joint {joint}", make)


def per_speed(motion: Motion, joint: int) -> np.ndarray:
    """∂τ/∂v_j, shape (n, dof)."""

    def make() -> np.ndarray:
        none, step = np.zeros_like(motion.time), np.full_like(motion.time, SPEED)
        return shifted_torque(motion, joint, none, dv=step) / SPEED

    return motion.remembered(f"torque per speed of joint {joint}", make)


def per_acceleration(motion: Motion, joint: int) -> np.ndarray:
    """∂τ/∂a_j, the joint's column of the mass matrix, shape (n, dof); the torque is linear in it."""

    def make() -> np.ndarray:
        return shifted_torque(motion, joint, np.zeros_like(motion.time), da=np.ones_like(motion.time))

    return motion.remembered(f"torque per acceleration of joint {joint}", make)


def first_order(motion: Motion, joint: int, dq: np.ndarray, dv: np.ndarray, da: np.ndarray) -> np.ndarray:
    """dq ∂τ/∂q_j + dv ∂τ/∂v_j + da ∂τ/∂a_j, shape (n, dof) [N m]."""
    slopes = (law(motion, joint) for law in (per_angle, per_speed, per_acceleration))
    return sum((d[:, None] * slope for d, slope in zip((dq, dv, da), slopes, strict=True)), np.zeros_like(motion.load))
