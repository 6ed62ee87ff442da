"""A Lagrangian by itself: all torque is mechanics."""

from __future__ import annotations

import equinox as eqx
import jax.numpy as jnp

from lagnet.models.dynamics import AbstractDynamics, solve_for_acceleration
from lagnet.models.lagrangians import euler_lagrange
from lagnet.models.lagrangians.lagrangian import AbstractLagrangian, Matrix, Vector


class OfLagrangian(AbstractDynamics):
    """What follows from a Lagrangian whatever its form; how acceleration and residual follow is left open."""

    lagrangian: eqx.AbstractVar[AbstractLagrangian]

    def inverse_dynamics(self, q: Vector, v: Vector, a: Vector) -> Vector:
        return self.lagrangian.inverse_dynamics(q, v, a)

    def mass_matrix(self, q: Vector) -> Matrix:
        return self.lagrangian.mass_matrix(q)

    def coriolis_matrix(self, q: Vector, v: Vector) -> Matrix:
        return euler_lagrange.coriolis_matrix(self.lagrangian.mass_matrix, q, v)

    def coriolis_torque(self, q: Vector, v: Vector) -> Vector:
        return euler_lagrange.coriolis_torque(self.lagrangian, q, v)

    def gravity_torque(self, q: Vector) -> Vector:
        return euler_lagrange.gravity_torque(self.lagrangian, q)


class Conservative(OfLagrangian):
    """Dynamics of an arm whose kinetic energy is ½ vᵀ H(q) v, so that nothing is left to a residual."""

    lagrangian: AbstractLagrangian

    def forward_dynamics(self, q: Vector, v: Vector, tau: Vector) -> Vector:
        return euler_lagrange.forward_dynamics(self.lagrangian, q, v, tau)

    def residual_torque(self, q: Vector, v: Vector, a: Vector) -> Vector:
        return jnp.zeros_like(q)


class FreeLagrangian(OfLagrangian):
    """Dynamics of a Lagrangian of any form: H is the inertia at rest, and its change with speed is the residual."""

    lagrangian: AbstractLagrangian

    def forward_dynamics(self, q: Vector, v: Vector, tau: Vector) -> Vector:
        return solve_for_acceleration(lambda a: self.inverse_dynamics(q, v, a), tau)

    def residual_torque(self, q: Vector, v: Vector, a: Vector) -> Vector:
        at_speed = self.lagrangian.inverse_dynamics(q, v, a)
        bias = self.lagrangian.inverse_dynamics(q, v, jnp.zeros_like(a))
        return at_speed - bias - self.mass_matrix(q) @ a
