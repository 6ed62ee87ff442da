"""Structured deep Lagrangian network whose two networks follow the chain of joints.

Kinetic energy is T = ½ |L̂(q)ᵀ v|² + ½ Σ d_j v_j², so H = L̂ L̂ᵀ + diag(d) with d > 0: positive definite whatever the
weights are. Row j of L̂ is what the velocity of joint j does to every body outboard of it, and depends on the joints
between them alone; the potential is a sum of heads along the chain. This is DeLaN (Lutter et al. 2019; Wu et al. 2024,
eqs 5–7) with a rectangular factor and with `ChainNetwork` in place of perceptrons; no kinematics are given.
"""

from __future__ import annotations

from dataclasses import dataclass

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from lagnet.errors import ModelError
from lagnet.models.chain_network import ChainNetwork, make_chain_network
from lagnet.models.features import JointFeatures
from lagnet.models.lagrangians import euler_lagrange
from lagnet.models.lagrangians.lagrangian import AbstractLagrangian, Matrix, Scalar, Vector
from lagnet.models.scales import Scales

LARGEST_RANK = 256


@dataclass(frozen=True)
class DelanSettings:
    """Size of the two chain networks.

    Args:
        rank: length of the state that carries velocity outwards; 6 would do for rigid bodies, more trains faster.
        potential_rank: length of the state that carries gravity; 4 would do for rigid bodies.
        floor: smallest diagonal inertia in units of torque over acceleration of its joint.
    """

    rank: int = 12
    potential_rank: int = 8
    floor: float = 1e-6

    def __post_init__(self) -> None:
        for name in ("rank", "potential_rank"):
            if not 1 <= getattr(self, name) <= LARGEST_RANK:
                raise ModelError(f"{name} is {getattr(self, name)}, expected 1 … {LARGEST_RANK}")


class Delan(AbstractLagrangian):
    """Energies of an arm, each carried along the joints by a chain network.

    Args:
        motion: carries velocity outwards.
        axes: shape (dof, rank), what unit velocity of each joint adds to the state.
        bodies: one (rank, rank) matrix a joint, root of the inertia that the state meets there.
        drives: shape (dof,), inertia d_j of each joint by itself, before the softplus.
        height: carries gravity outwards; start: its state at the base, shape (potential_rank,).
        weights: shape (dof, potential_rank), what hangs on each joint.
    """

    motion: ChainNetwork
    axes: Array
    bodies: tuple[Array, ...]
    drives: Array
    height: ChainNetwork
    start: Array
    weights: Array
    features: JointFeatures = eqx.field(static=True)
    scales: Scales = eqx.field(static=True)
    settings: DelanSettings = eqx.field(static=True)

    def body_speeds(self, q: Vector, v: Vector) -> Array:
        """L̂(q)ᵀ v, shape (dof · rank,), the root of twice the kinetic energy, body by body."""
        entries = tuple(self.axes * v[:, None])
        states = self.motion(self.features(q), jnp.zeros_like(self.start, shape=self.axes.shape[1]), entries)
        root = np.sqrt(self.scales.inertia)
        return jnp.concatenate([(body @ x) * s for body, x, s in zip(self.bodies, states, root.tolist(), strict=True)])

    def drive_inertia(self) -> Vector:
        """Inertia that each joint has by itself [kg m²], above the floor."""
        return (jax.nn.softplus(self.drives) + self.settings.floor) * np.asarray(self.scales.inertia, self.drives.dtype)

    def kinetic_energy(self, q: Vector, v: Vector) -> Scalar:
        return 0.5 * jnp.sum(self.body_speeds(q, v) ** 2) + 0.5 * jnp.sum(self.drive_inertia() * v**2)

    def potential_energy(self, q: Vector) -> Scalar:
        states = self.height(self.features(q), self.start, (None,) * len(self.weights))
        heads = jnp.sum(self.weights * jnp.stack(states), axis=1)
        return heads @ np.asarray(self.scales.torque, heads.dtype)

    def inverse_dynamics(self, q: Vector, v: Vector, a: Vector) -> Vector:
        return euler_lagrange.inverse_dynamics(self, q, v, a)

    def momentum(self, q: Vector, v: Vector) -> Vector:
        speeds, pull_back = jax.vjp(lambda x: self.body_speeds(q, x), v)
        return pull_back(speeds)[0] + self.drive_inertia() * v

    def mass_matrix(self, q: Vector) -> Matrix:
        factor = jax.vmap(lambda unit: self.body_speeds(q, unit))(jnp.eye(len(self.axes), dtype=q.dtype))
        return factor @ factor.T + jnp.diag(self.drive_inertia())


def make_delan(key: Array, features: JointFeatures, scales: Scales, settings: DelanSettings) -> Delan:
    """Draw an untrained model."""
    n, rank, potential_rank = len(features.joint_types), settings.rank, settings.potential_rank
    keys = jax.random.split(key, 6)
    bodies = jax.random.normal(keys[2], (n, rank, rank)) / np.sqrt(n * rank)
    return Delan(
        motion=make_chain_network(keys[0], features.owner, n, rank),
        axes=jax.random.normal(keys[1], (n, rank)),
        bodies=tuple(bodies),
        drives=jnp.zeros(n) - 5.0,
        height=make_chain_network(keys[3], features.owner, n, potential_rank),
        start=jax.random.normal(keys[4], (potential_rank,)),
        weights=jax.random.normal(keys[5], (n, potential_rank)) / np.sqrt(potential_rank),
        features=features.on_circle,
        scales=scales,
        settings=settings,
    )
