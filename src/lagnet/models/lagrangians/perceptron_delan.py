"""Structured deep Lagrangian network of the paper: H(q) = U(q) U(q)ᵀ and V(q) from two perceptrons.

With coupling "serial" two facts of every serial arm are built in. Turning or sliding joint i carries everything
outboard of it rigidly along, so entry (i, j) of the inertia depends only on joints outboard of min(i, j): U is upper
triangular and its row i sees those joints alone. What hangs on joint k is a matter of joints 0 … k, so the potential
is a sum of heads, each scaled by the torque of its joint: a wrist is not drowned by the shoulder. The last head sees
all joints, so the sum can still be any function of q. Source: Lutter et al. 2019; Wu et al. 2024, eqs 5–7.
"""

from __future__ import annotations

from dataclasses import dataclass

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from lagnet.errors import ModelError
from lagnet.models.features import JointFeatures
from lagnet.models.lagrangians.lagrangian import AbstractLagrangian, Matrix, Scalar, Vector
from lagnet.models.networks import OrderedNetwork, check_widths, make_network
from lagnet.models.scales import Scales

COUPLINGS = ("serial", "general")


@dataclass(frozen=True)
class PerceptronDelanSettings:
    """Size and structure of the two networks.

    Args:
        hidden: widths of the hidden layers, the same for inertia and potential.
        activation: nonlinearity between layers; smooth, as torques need two derivatives.
        coupling: "serial" for chains of bodies; "general" lets every inertia entry see every joint (coupled drives,
            loops).
        floor: smallest diagonal of U in units of its scale, which keeps H positive definite.
    """

    hidden: tuple[int, ...] = (128, 128)
    activation: str = "silu"
    coupling: str = "serial"
    floor: float = 1e-3

    def __post_init__(self) -> None:
        check_widths(self.hidden)
        if self.coupling not in COUPLINGS:
            raise ModelError(f"coupling {self.coupling!r} is unknown", choices=COUPLINGS)


class PerceptronDelan(AbstractLagrangian):
    """Kinetic energy ½ |U(q)ᵀ v|² and potential energy Σ_k s_k V_k(q), positive definite by construction."""

    inertia: OrderedNetwork
    potential: OrderedNetwork
    features: JointFeatures = eqx.field(static=True)
    scales: Scales = eqx.field(static=True)
    settings: PerceptronDelanSettings = eqx.field(static=True)

    def factor(self, q: Vector) -> Matrix:
        """Upper-triangular U(q) with H = U Uᵀ, rows scaled by the inertia that torque and acceleration suggest."""
        return self._factor(self.inertia(self.features(q)))[0]

    def _factor(self, raw: Array) -> tuple[Matrix, Matrix]:
        """U from the outputs of the network, and the derivative of each entry by its output."""
        n = len(self.scales.inertia)
        # Masks, not scattered entries: a scatter and its derivatives cost more here than both networks.
        upper, diagonal = np.triu(np.ones((n, n)), 1).astype(raw.dtype), np.eye(n, dtype=raw.dtype)
        root = np.sqrt(np.asarray(self.scales.inertia)).astype(raw.dtype)[:, None]
        own = raw[:: n + 1, None]
        factor = raw.reshape(n, n) * upper + (jax.nn.softplus(own) + self.settings.floor) * diagonal
        bent = jnp.asarray(upper) + jax.nn.sigmoid(own) * diagonal
        return factor * root, bent * root

    def inverse_dynamics(self, q: Vector, v: Vector, a: Vector) -> Vector:
        """Torque [N m]: one pass through the network of U with its change along v, one back, one of V and back.

        Sums of products in place of products of small matrices, which cost more than both networks in a batch.
        """
        inputs, slopes = jax.jvp(self.features, (q,), (jnp.ones_like(q),))
        owner = np.eye(len(q), dtype=q.dtype)[:, np.asarray(self.features.owner)]
        raw, along, back = self.inertia.linearised(inputs)
        factor, bent = self._factor(raw)
        rate = bent * along(slopes * (v @ owner)).reshape(bent.shape)
        speed = jnp.sum(factor * v[:, None], axis=0)
        change = jnp.sum(rate * v[:, None] + factor * a[:, None], axis=0)
        force = back((bent * v[:, None] * speed[None, :]).ravel())
        pull = self.potential.linearised(inputs)[2](jnp.asarray(self.scales.torque, raw.dtype))
        return jnp.sum(rate * speed[None, :] + factor * change[None, :], axis=1) + owner @ (slopes * (pull - force))

    def kinetic_energy(self, q: Vector, v: Vector) -> Scalar:
        return 0.5 * jnp.sum((self.factor(q).T @ v) ** 2)

    def potential_energy(self, q: Vector) -> Scalar:
        heads = self.potential(self.features(q))
        return heads @ np.asarray(self.scales.torque).astype(heads.dtype)

    def momentum(self, q: Vector, v: Vector) -> Vector:
        factor = self.factor(q)
        return factor @ (factor.T @ v)

    def mass_matrix(self, q: Vector) -> Matrix:
        factor = self.factor(q)
        return factor @ factor.T


def make_perceptron_delan(
    key: Array, features: JointFeatures, scales: Scales, settings: PerceptronDelanSettings
) -> PerceptronDelan:
    """Draw an untrained model."""
    n = len(features.joint_types)
    mass_key, potential_key = jax.random.split(key)
    rows = tuple(row for row in range(n) for _ in range(n))
    serial = settings.coupling == "serial"
    outboard = tuple(row + 1 for row in rows) if serial else (0,) * len(rows)
    shares = tuple(d for d in range(1, n) for _ in range(n - d)) if serial and n > 1 else (0,)
    inertia = make_network(mass_key, features.owner, outboard, settings.hidden, settings.activation, shares)
    inboard = tuple(-joint for joint in features.owner)
    shares = tuple(-k for k in range(n) for _ in range(k + 1))
    heads = tuple(-k for k in range(n))
    potential = make_network(potential_key, inboard, heads, settings.hidden, settings.activation, shares)
    return PerceptronDelan(inertia, potential, features, scales, settings)
