"""Eq. 12: squared torque error in units of each joint's torque variance, plus λ times ε squared in the same units."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array

from lagnet.models.dynamics import AbstractDynamics
from lagnet.models.residuals.augmented import Augmented


class Errors(NamedTuple):
    """Torque error of each joint and size of ε of each joint, as shares of the torque variance, shape (dof,)."""

    torque: Array
    epsilon: Array


def errors(dynamics: AbstractDynamics, batch: tuple[Array, ...], variance: Array) -> Errors:
    """Mean squares over a batch (q, v, a, tau), each (n, dof), divided by the torque variance (dof,)."""
    q, v, a, tau = batch
    predicted, epsilon = jax.vmap(_parts(dynamics))(q, v, a)
    return Errors(*(jnp.mean(x**2, axis=0) / variance for x in (predicted - tau, epsilon)))


def penalised(found: Errors, penalty: Array | float) -> Array:
    """The scalar that training lowers: mean over joints of torque error + λ ε²."""
    return jnp.mean(found.torque) + penalty * jnp.mean(found.epsilon)


def _parts(dynamics: AbstractDynamics) -> Callable[[Array, Array, Array], tuple[Array, Array]]:
    """Torque and ε of one sample, ε computed once."""
    if not isinstance(dynamics, Augmented):
        return lambda q, v, a: (dynamics.inverse_dynamics(q, v, a), jnp.zeros_like(q))

    def both(q: Array, v: Array, a: Array) -> tuple[Array, Array]:
        epsilon = dynamics.epsilon(q, v, a)
        return dynamics.mechanics.inverse_dynamics(q, v, a) + epsilon, epsilon

    return both
