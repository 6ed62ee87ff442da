"""No mechanics at all: what stands under ε while ε is trained alone on what mechanics left."""

from __future__ import annotations

import jax.numpy as jnp

from lagnet.models.dynamics import AbstractDynamics
from lagnet.models.lagrangians.lagrangian import Matrix, Vector


class Massless(AbstractDynamics):
    """An arm that asks for no torque, whatever it does; it has no forward dynamics."""

    def inverse_dynamics(self, q: Vector, v: Vector, a: Vector) -> Vector:
        return jnp.zeros_like(q)

    def forward_dynamics(self, q: Vector, v: Vector, tau: Vector) -> Vector:
        return jnp.full_like(q, jnp.nan)  # any acceleration goes with no torque

    def mass_matrix(self, q: Vector) -> Matrix:
        return jnp.zeros((q.size, q.size), q.dtype)

    def coriolis_matrix(self, q: Vector, v: Vector) -> Matrix:
        return jnp.zeros((q.size, q.size), q.dtype)

    def coriolis_torque(self, q: Vector, v: Vector) -> Vector:
        return jnp.zeros_like(q)

    def gravity_torque(self, q: Vector) -> Vector:
        return jnp.zeros_like(q)

    def residual_torque(self, q: Vector, v: Vector, a: Vector) -> Vector:
        return jnp.zeros_like(q)
