"""A perceptron from (q, v, a) to torque: the whole model in an FFNN, the remainder ε in DeLaN-FFNN."""

from __future__ import annotations

from dataclasses import dataclass

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from lagnet.models.features import JointFeatures
from lagnet.models.lagrangians.lagrangian import Vector
from lagnet.models.networks import OrderedNetwork, check_widths, make_network
from lagnet.models.scales import Scales

SLOW = 0.05  # blurred sign of velocity: tanh(v / (SLOW · typical speed)), what dry friction looks like


@dataclass(frozen=True)
class TorqueNetworkSettings:
    """Hidden widths and nonlinearity of the perceptron."""

    hidden: tuple[int, ...] = (128, 128)
    activation: str = "silu"

    def __post_init__(self) -> None:
        check_widths(self.hidden)


class TorqueNetwork(eqx.Module):
    """Torque [N m] from position features, scaled velocity and its blurred sign, and scaled acceleration."""

    network: OrderedNetwork
    features: JointFeatures = eqx.field(static=True)
    scales: Scales = eqx.field(static=True)
    settings: TorqueNetworkSettings = eqx.field(static=True)

    def __call__(self, q: Vector, v: Vector, a: Vector) -> Vector:
        """Torque at one sample, shape (dof,) [N m]."""
        speed = v / np.asarray(self.scales.velocity, v.dtype)
        acceleration = a / np.asarray(self.scales.acceleration, a.dtype)
        inputs = jnp.concatenate([self.features(q), speed, jnp.tanh(speed / SLOW), acceleration])
        return self.network(inputs) * np.asarray(self.scales.torque, inputs.dtype)

    def scaled(self, shares: np.ndarray) -> TorqueNetwork:
        """The same with the torque of each joint times its share, shape (dof,)."""
        last = self.network.weights[-1], self.network.biases[-1]
        smaller = tuple(x * shares.reshape(-1, *[1] * (x.ndim - 1)).astype(x.dtype) for x in last)
        return eqx.tree_at(lambda x: (x.network.weights[-1], x.network.biases[-1]), self, smaller)


def make_torque_network(
    key: Array, features: JointFeatures, scales: Scales, settings: TorqueNetworkSettings
) -> TorqueNetwork:
    """Draw an untrained network."""
    n = len(features.joint_types)
    inputs = (0,) * (len(features.owner) + 3 * n)
    network = make_network(key, inputs, (0,) * n, settings.hidden, settings.activation)
    return TorqueNetwork(network, features, scales, settings)


def silenced(torque: TorqueNetwork) -> TorqueNetwork:
    """The same network with its last layer at zero, so that as an ε it starts by taking nothing."""
    return eqx.tree_at(lambda x: x.network.weights[-1], torque, replace_fn=jnp.zeros_like)
