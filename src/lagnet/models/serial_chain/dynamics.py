"""A serial arm and what its joints add, answering every call of a dynamics model for one sample."""

from __future__ import annotations

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array

from lagnet.models import euler_lagrange
from lagnet.models.dynamics import AbstractDynamics
from lagnet.models.lagrangian import Matrix, Vector
from lagnet.models.serial_chain.joint_terms import joint_term_columns
from lagnet.models.serial_chain.newton_euler import SerialArm


class SerialChainDynamics(AbstractDynamics):
    """Newton–Euler torque of rigid links, rotors included, plus friction, offsets and springs as the residual.

    Args:
        arm: the rigid part.
        joint_terms: names of the terms beside rotor inertia.
        coefficients: shape (terms, dof), their coefficients.
        slow_speed: shape (dof,), speed over which Coulomb friction changes sign [rad/s].
    """

    arm: SerialArm
    coefficients: Array
    slow_speed: Array
    joint_terms: tuple[str, ...] = eqx.field(static=True)

    def inverse_dynamics(self, q: Vector, v: Vector, a: Vector) -> Vector:
        return self.arm.inverse_dynamics(q, v, a) + self.residual_torque(q, v, a)

    def forward_dynamics(self, q: Vector, v: Vector, tau: Vector) -> Vector:
        rest = jnp.zeros_like(q)
        bias = self.inverse_dynamics(q, v, rest)
        return jnp.linalg.solve(self.arm.mass_matrix(q), tau - bias)

    def mass_matrix(self, q: Vector) -> Matrix:
        return self.arm.mass_matrix(q)

    def coriolis_matrix(self, q: Vector, v: Vector) -> Matrix:
        return euler_lagrange.coriolis_matrix(self.arm.mass_matrix, q, v)

    def coriolis_torque(self, q: Vector, v: Vector) -> Vector:
        rest = jnp.zeros_like(q)
        return self.arm.inverse_dynamics(q, v, rest) - self.gravity_torque(q)

    def gravity_torque(self, q: Vector) -> Vector:
        rest = jnp.zeros_like(q)
        return self.arm.inverse_dynamics(q, rest, rest)

    def residual_torque(self, q: Vector, v: Vector, a: Vector) -> Vector:
        return joint_term_columns(self.joint_terms, self.slow_speed, q, v, a) @ self.coefficients.reshape(-1)
