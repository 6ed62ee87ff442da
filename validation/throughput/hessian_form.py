"""The usual formulation, for the benchmark alone: torque from Hessians of the Lagrangian, τ = L_vv a + L_vq v − L_q."""

from __future__ import annotations

import jax
from jaxtyping import Array

from lagnet.models.lagrangians.lagrangian import AbstractLagrangian, Vector


def hessian_inverse_dynamics(arm: AbstractLagrangian, q: Vector, v: Vector, a: Vector) -> Array:
    """Torque [N m] of one sample, from the full second derivatives of L = T − V."""

    def lagrangian(q: Vector, v: Vector) -> Array:
        return arm.kinetic_energy(q, v) - arm.potential_energy(q)

    (_, _), (mixed, inertia) = jax.hessian(lagrangian, argnums=(0, 1))(q, v)
    return inertia @ a + mixed @ v - jax.grad(lagrangian)(q, v)
