"""What every model answers for one sample, whatever it is made of: pure JAX, (dof,) in and out."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array

from lagnet.models.lagrangians.lagrangian import Matrix, Vector

NEWTON_STEPS = (
    8  # at most: the torque is linear in a but for ε, which is small or smooth, so that convergence is quadratic
)
SETTLED = 1e-10  # of the acceleration: after so small a step the error is its square, below rounding


class AbstractDynamics(eqx.Module):
    """An arm's dynamics: torque from motion, its parts, and motion from torque.

    τ(q, v, a) = H(q) a + c(q, v) + g(q) + residual(q, v, a) holds for every model by the definition of the residual.
    """

    @abstractmethod
    def inverse_dynamics(self, q: Vector, v: Vector, a: Vector) -> Vector:
        """Whole torque, ε included, shape (dof,) [N m]."""

    @abstractmethod
    def forward_dynamics(self, q: Vector, v: Vector, tau: Vector) -> Vector:
        """Acceleration under torque tau, shape (dof,) [rad/s²]."""

    @abstractmethod
    def mass_matrix(self, q: Vector) -> Matrix:
        """H(q), shape (dof, dof) [kg m²]."""

    @abstractmethod
    def coriolis_matrix(self, q: Vector, v: Vector) -> Matrix:
        """Christoffel factor C(q, v) of H, shape (dof, dof) [N m s/rad]."""

    @abstractmethod
    def coriolis_torque(self, q: Vector, v: Vector) -> Vector:
        """c(q, v), shape (dof,) [N m]."""

    @abstractmethod
    def gravity_torque(self, q: Vector) -> Vector:
        """g(q), shape (dof,) [N m]."""

    @abstractmethod
    def residual_torque(self, q: Vector, v: Vector, a: Vector) -> Vector:
        """What H a + c + g leave of the whole torque, shape (dof,) [N m]."""


def solve_for_acceleration(torque: Callable[[Vector], Vector], tau: Vector) -> Vector:
    """The a at which torque(a) = tau, by Newton steps from rest until a step is too small to matter."""

    def step(state: tuple[Vector, Vector, Array]) -> tuple[Vector, Vector, Array]:
        a, _, count = state
        reached, along = jax.linearize(torque, a)
        slope = jax.vmap(along, out_axes=1)(jnp.eye(a.size, dtype=a.dtype))
        change = jnp.linalg.solve(slope, tau - reached)
        return a + change, change, count + 1

    def unfinished(state: tuple[Vector, Vector, Array]) -> Array:
        a, change, count = state
        return (count < NEWTON_STEPS) & (jnp.abs(change).max() > SETTLED * jnp.abs(a).max())

    begin = jnp.zeros_like(tau), jnp.full_like(tau, jnp.inf), jnp.array(0)
    return jax.lax.while_loop(unfinished, step, begin)[0]
