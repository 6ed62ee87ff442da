"""FFNN: torque straight from (q, v, a), with no mechanics inside.

Its terms are differences of the network f: g = f(q, 0, 0), c = f(q, v, 0) − g, and column i of H is f(q, 0, e_i) − g.
Nothing makes that H symmetric or positive, nor the sum of the terms the torque: the rest is given as the residual.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp

from lagnet.models.dynamics import AbstractDynamics, solve_for_acceleration
from lagnet.models.lagrangians import euler_lagrange
from lagnet.models.lagrangians.lagrangian import Matrix, Vector
from lagnet.models.residuals.torque_network import TorqueNetwork


class FeedForward(AbstractDynamics):
    """Dynamics of one perceptron."""

    network: TorqueNetwork

    def inverse_dynamics(self, q: Vector, v: Vector, a: Vector) -> Vector:
        return self.network(q, v, a)

    def forward_dynamics(self, q: Vector, v: Vector, tau: Vector) -> Vector:
        return solve_for_acceleration(lambda a: self.network(q, v, a), tau)

    def mass_matrix(self, q: Vector) -> Matrix:
        rest = jnp.zeros_like(q)
        columns = jax.vmap(lambda unit: self.network(q, rest, unit))(jnp.eye(q.shape[0], dtype=q.dtype))
        return (columns - self.gravity_torque(q)[None, :]).T

    def coriolis_matrix(self, q: Vector, v: Vector) -> Matrix:
        return euler_lagrange.coriolis_matrix(self.mass_matrix, q, v)

    def coriolis_torque(self, q: Vector, v: Vector) -> Vector:
        rest = jnp.zeros_like(q)
        return self.network(q, v, rest) - self.network(q, rest, rest)

    def gravity_torque(self, q: Vector) -> Vector:
        rest = jnp.zeros_like(q)
        return self.network(q, rest, rest)

    def residual_torque(self, q: Vector, v: Vector, a: Vector) -> Vector:
        mechanics = self.mass_matrix(q) @ a + self.coriolis_torque(q, v) + self.gravity_torque(q)
        return self.network(q, v, a) - mechanics
