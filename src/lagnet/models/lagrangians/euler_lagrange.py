"""Torques that follow from energies: one forward pass of the momentum, one reverse pass of T − V, no Hessians.

Euler–Lagrange says τ = d/dt ∂L/∂v − ∂L/∂q. The first term is the derivative of p(q, v) along (v, a), a Jacobian–vector
product; the second is a gradient of a scalar. All functions take one sample and are pure JAX.
"""

from __future__ import annotations

from collections.abc import Callable

import jax
import jax.numpy as jnp
from jax.scipy.linalg import cho_factor, cho_solve

from lagnet.models.lagrangians.lagrangian import AbstractLagrangian, Matrix, Vector


def inverse_dynamics(arm: AbstractLagrangian, q: Vector, v: Vector, a: Vector) -> Vector:
    """Torque [N m] that makes the arm move with acceleration a at (q, v)."""
    _, momentum_rate = jax.jvp(arm.momentum, (q, v), (v, a))
    force = jax.grad(lambda x: arm.kinetic_energy(x, v) - arm.potential_energy(x))(q)
    return momentum_rate - force


def gravity_torque(arm: AbstractLagrangian, q: Vector) -> Vector:
    """Torque [N m] that holds the arm still: ∂V/∂q."""
    return jax.grad(arm.potential_energy)(q)


def coriolis_torque(arm: AbstractLagrangian, q: Vector, v: Vector) -> Vector:
    """Centrifugal and Coriolis torque c(q, v) [N m]: what motion at constant speed asks beyond gravity."""
    _, momentum_rate = jax.jvp(lambda x: arm.momentum(x, v), (q,), (v,))
    return momentum_rate - jax.grad(arm.kinetic_energy)(q, v)


def coriolis_matrix(mass_matrix: Callable[[Vector], Matrix], q: Vector, v: Vector) -> Matrix:
    """The factorisation c = C v by Christoffel symbols, for which Ṁ − 2C is skew; shape (dof, dof) [N m s/rad].

    C_ij = ½ Σ_k (∂M_ij/∂q_k + ∂M_ik/∂q_j − ∂M_jk/∂q_i) v_k: one forward pass gives Ṁ, one Jacobian of M(q) v the rest.
    """
    _, mass_rate = jax.jvp(mass_matrix, (q,), (v,))
    slope = jax.jacfwd(lambda x: mass_matrix(x) @ v)(q)
    return 0.5 * (mass_rate + slope - slope.T)


def forward_dynamics(arm: AbstractLagrangian, q: Vector, v: Vector, tau: Vector) -> Vector:
    """Acceleration [rad/s²] under torque tau, by a Cholesky solve of M a = τ − c − g."""
    bias = inverse_dynamics(arm, q, v, jnp.zeros_like(v))
    return cho_solve(cho_factor(arm.mass_matrix(q)), tau - bias)
