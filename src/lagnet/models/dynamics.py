"""What every model answers for one sample, whatever it is made of: pure JAX, (dof,) in and out."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable

import equinox as eqx
import jax
import jax.numpy as jnp

from lagnet.models.lagrangian import Matrix, Vector

NEWTON_STEPS = 8  # the torque is linear in a but for ε, which is small or smooth: convergence is quadratic


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
    """The a at which torque(a) = tau, by Newton steps from rest."""

    def step(a: Vector, _: None) -> tuple[Vector, None]:
        slope = jax.jacfwd(torque)(a)
        return a + jnp.linalg.solve(slope, tau - torque(a)), None

    return jax.lax.scan(step, jnp.zeros_like(tau), None, length=NEWTON_STEPS)[0]
