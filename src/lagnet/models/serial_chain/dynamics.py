"""A serial arm and what its joints add, answering every call of a dynamics model for one sample."""

from __future__ import annotations

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array

from lagnet.models.dynamics import AbstractDynamics
from lagnet.models.features import JointFeatures
from lagnet.models.lagrangians import euler_lagrange
from lagnet.models.lagrangians.lagrangian import Matrix, Vector
from lagnet.models.scales import Scales
from lagnet.models.serial_chain.mechanics.joint_terms import joint_term_columns
from lagnet.models.serial_chain.mechanics.kinematics import Geometry, revolute_mask
from lagnet.models.serial_chain.mechanics.newton_euler import SerialArm
from lagnet.models.serial_chain.settings import SLOW, STANDARD_GRAVITY, SerialChainSettings


class SerialChainDynamics(AbstractDynamics):
    """Newton–Euler torque of rigid links, rotors included, plus friction, offsets and springs as the residual.

    Args:
        lagrangian: the rigid part, rotors included.
        joint_terms: names of the terms beside rotor inertia.
        coefficients: shape (terms, dof), their coefficients.
        slow_speed: shape (dof,), speed over which Coulomb friction changes sign [rad/s].
    """

    lagrangian: SerialArm
    coefficients: Array
    slow_speed: Array
    joint_terms: tuple[str, ...] = eqx.field(static=True)

    def inverse_dynamics(self, q: Vector, v: Vector, a: Vector) -> Vector:
        return self.lagrangian.inverse_dynamics(q, v, a) + self.residual_torque(q, v, a)

    def forward_dynamics(self, q: Vector, v: Vector, tau: Vector) -> Vector:
        rest = jnp.zeros_like(q)
        bias = self.inverse_dynamics(q, v, rest)
        return jnp.linalg.solve(self.lagrangian.mass_matrix(q), tau - bias)

    def mass_matrix(self, q: Vector) -> Matrix:
        return self.lagrangian.mass_matrix(q)

    def coriolis_matrix(self, q: Vector, v: Vector) -> Matrix:
        return euler_lagrange.coriolis_matrix(self.lagrangian.mass_matrix, q, v)

    def coriolis_torque(self, q: Vector, v: Vector) -> Vector:
        rest = jnp.zeros_like(q)
        return self.lagrangian.inverse_dynamics(q, v, rest) - self.gravity_torque(q)

    def gravity_torque(self, q: Vector) -> Vector:
        rest = jnp.zeros_like(q)
        return self.lagrangian.inverse_dynamics(q, rest, rest)

    def residual_torque(self, q: Vector, v: Vector, a: Vector) -> Vector:
        return joint_term_columns(self.joint_terms, self.slow_speed, q, v, a) @ self.coefficients.reshape(-1)


def make_serial_chain(
    key: Array, features: JointFeatures, scales: Scales, settings: SerialChainSettings
) -> SerialChainDynamics:
    """An arm drawn at random, with the joints and terms at hand: the shape into which a fitted or saved one is put."""
    n = len(features.joint_types)
    turns, lengths = jax.random.split(key)
    geometry = Geometry(
        jax.random.uniform(turns, (n - 1, 2), minval=-jnp.pi, maxval=jnp.pi),
        0.3 * jax.random.normal(lengths, (n - 1, 2)),
        jnp.array([0.0, 0.0, -STANDARD_GRAVITY]),
    )
    moments = jnp.tile(jnp.array([0.01, 0.01, 0.01, 0, 0, 0, 0, 0, 0, 1.0]), (n, 1))
    arm = SerialArm(geometry, moments, jnp.zeros(n), revolute_mask(features.joint_types))
    beside = tuple(name for name in settings.joint_terms if name != "rotor_inertia")
    return SerialChainDynamics(arm, jnp.zeros((len(beside), n)), SLOW * jnp.array(scales.velocity), beside)
