"""An ε that can only take energy out: drag on every body and friction in every joint.

Every body that moves through a medium, or in a simulator with damped links, meets a wrench against its motion that
grows with its speed. Velocity is carried along the chain as in `delan`: x is the motion that v gives a body, and the
wrench on it is D x with D = BᵀB + Σ_k |S_k x| C_kᵀC_k: linear drag, and drag that grows with a speed of the body, once
for its translation and once for its turning. Virtual work brings it back to the joints, each of which adds
d v + f tanh(v/v₀), viscous and dry friction. Every D is positive, so v · ε ≥ 0; and ε is odd in v, so it can be neither
H a, nor c, nor g.
The linear part is the slope of Rayleigh's (1873) dissipation function. A wrench of quadratic drag has none in general:
I ω |ω| of a body whose moments differ is the gradient of nothing.
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
from lagnet.models.lagrangians.lagrangian import Vector
from lagnet.models.residuals.torque_network import SLOW
from lagnet.models.scales import Scales

DRAGS = 2  # of a body: by its translation and by its turning
LITTLE = 0.1  # root of the friction that an untrained joint has, over that of its typical power
SMALL = 1e-6  # of a typical speed squared: rounds the tip of |S x|, whose slope is not defined there


@dataclass(frozen=True)
class DissipationSettings:
    """Size of the chain network: length of the state that carries velocity outwards."""

    rank: int = 12

    def __post_init__(self) -> None:
        if not 1 <= self.rank <= 256:
            raise ModelError(f"rank is {self.rank}, expected 1 … 256")


class DissipationNetwork(eqx.Module):
    """ε of drag and friction, each joint times its share.

    Args:
        motion: carries velocity outwards; axes: shape (dof, rank), what unit speed of each joint adds.
        linear: shape (dof, rank, rank), B of each body.
        speeds, quadratic: shape (DRAGS, dof, rank, rank), S_k and C_k of each body.
        viscous, dry: shape (dof,), roots of d and f of each joint.
        shares: shape (dof,), what of ε counts on each joint; not trained, 1 unless held-out torque bears out less. With
            different shares v · ε may be negative.
    """

    motion: ChainNetwork
    axes: Array
    linear: Array
    speeds: Array
    quadratic: Array
    viscous: Array
    dry: Array
    shares: Array
    features: JointFeatures = eqx.field(static=True)
    scales: Scales = eqx.field(static=True)
    settings: DissipationSettings = eqx.field(static=True)

    def __call__(self, q: Vector, v: Vector, a: Vector) -> Vector:
        """Torque at one sample, shape (dof,) [N m]; a is not looked at."""
        size = np.asarray(self.scales.velocity, v.dtype)
        power = (np.asarray(self.scales.torque) * np.asarray(self.scales.velocity)).astype(v.dtype)
        features = self.features(q)

        def motion(speed: Vector) -> Array:
            entries = tuple(self.axes * speed[:, None])
            return jnp.stack(self.motion(features, jnp.zeros_like(self.axes[0]), entries))

        x, virtual_work = jax.vjp(motion, v / size)
        friction = self.viscous**2 * v / size + self.dry**2 * jnp.tanh(v / size / SLOW)
        wrench = wrench_of(self.linear, self.speeds, self.quadratic, x)
        force = virtual_work(power[:, None] * wrench)[0] + power * friction
        return jax.lax.stop_gradient(self.shares) * force / size

    def scaled(self, shares: np.ndarray) -> DissipationNetwork:
        """The same with the torque of each joint times its share, shape (dof,)."""
        return eqx.tree_at(lambda x: x.shares, self, self.shares * shares.astype(self.shares.dtype))


def wrench_of(linear: Array, speeds: Array, quadratic: Array, x: Array) -> Array:
    """Wrench against the motion x of each body, both of shape (dof, rank); roots as in `DissipationNetwork`."""
    wrench = _square(linear, x)
    for seen, root in zip(speeds, quadratic, strict=True):
        speed = jnp.sqrt(jnp.sum(_each(seen, x) ** 2, axis=1, keepdims=True) + SMALL)
        wrench += speed * _square(root, x)
    return wrench


def _each(matrices: Array, x: Array) -> Array:
    """Each body's matrix times its motion."""
    return jnp.einsum("nij,nj->ni", matrices, x)


def _square(roots: Array, x: Array) -> Array:
    """RᵀR x of each body."""
    return jnp.einsum("nji,nj->ni", roots, _each(roots, x))


def draw_roots(keys: Array, n_joints: int, rank: int, drags: int) -> tuple[Array, Array, Array]:
    """Roots `linear`, `speeds` and `quadratic` of bodies that take little, each with its key."""
    size = 0.3 / (np.sqrt(n_joints) * rank)
    return (
        size * jax.random.normal(keys[0], (n_joints, rank, rank)),
        0.3 / np.sqrt(rank) * jax.random.normal(keys[1], (drags, n_joints, rank, rank)),
        size * jax.random.normal(keys[2], (drags, n_joints, rank, rank)),
    )


def make_dissipation(
    key: Array, features: JointFeatures, scales: Scales, settings: DissipationSettings
) -> DissipationNetwork:
    """Draw an untrained network that takes little."""
    n, rank = len(features.joint_types), settings.rank
    keys = jax.random.split(key, 5)
    linear, speeds, quadratic = draw_roots(keys[2:], n, rank, DRAGS)
    return DissipationNetwork(
        motion=make_chain_network(keys[0], features.owner, n, rank),
        axes=jax.random.normal(keys[1], (n, rank)),
        linear=linear,
        speeds=speeds,
        quadratic=quadratic,
        viscous=LITTLE * jnp.ones(n),
        dry=LITTLE * jnp.ones(n),
        shares=jnp.ones(n),
        features=features.on_circle,
        scales=scales,
        settings=settings,
    )
