"""Deep Lagrangian network, black box: one perceptron for L(q, v), with no form given to the energies.

Torques still follow from Euler–Lagrange, but the inertia ∂²L/∂v² need be neither positive nor the same at all speeds:
the mass matrix given is that at rest. Source: Wu et al. 2024, the "DeLaN black-box Lagrangian".
"""

from __future__ import annotations

from dataclasses import dataclass

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from lagnet.models.features import JointFeatures
from lagnet.models.lagrangians import euler_lagrange
from lagnet.models.lagrangians.lagrangian import AbstractLagrangian, Matrix, Scalar, Vector
from lagnet.models.networks import OrderedNetwork, check_widths, make_network
from lagnet.models.scales import Scales


@dataclass(frozen=True)
class BlackBoxSettings:
    """Hidden widths and nonlinearity of the perceptron."""

    hidden: tuple[int, ...] = (128, 128)
    activation: str = "silu"

    def __post_init__(self) -> None:
        check_widths(self.hidden)


class BlackBoxLagrangian(AbstractLagrangian):
    """Heads L_k(q, v), one a joint, weighted by the torque of the joint and summed."""

    network: OrderedNetwork
    features: JointFeatures = eqx.field(static=True)
    scales: Scales = eqx.field(static=True)
    settings: BlackBoxSettings = eqx.field(static=True)

    def lagrangian(self, q: Vector, v: Vector) -> Scalar:
        """L(q, v) [J]."""
        speed = v / np.asarray(self.scales.velocity, v.dtype)
        heads = self.network(jnp.concatenate([self.features(q), speed]))
        return heads @ np.asarray(self.scales.torque, heads.dtype)

    def kinetic_energy(self, q: Vector, v: Vector) -> Scalar:
        return self.lagrangian(q, v) - self.lagrangian(q, jnp.zeros_like(v))

    def potential_energy(self, q: Vector) -> Scalar:
        return -self.lagrangian(q, jnp.zeros_like(q))

    def inverse_dynamics(self, q: Vector, v: Vector, a: Vector) -> Vector:
        return euler_lagrange.inverse_dynamics(self, q, v, a)

    def momentum(self, q: Vector, v: Vector) -> Vector:
        return jax.grad(self.lagrangian, argnums=1)(q, v)

    def mass_matrix(self, q: Vector) -> Matrix:
        return jax.jacfwd(self.momentum, argnums=1)(q, jnp.zeros_like(q))


def make_black_box(
    key: Array, features: JointFeatures, scales: Scales, settings: BlackBoxSettings
) -> BlackBoxLagrangian:
    """Draw an untrained model."""
    n = len(features.joint_types)
    inputs = (0,) * (len(features.owner) + n)
    network = make_network(key, inputs, (0,) * n, settings.hidden, settings.activation)
    return BlackBoxLagrangian(network, features, scales, settings)
