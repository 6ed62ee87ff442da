"""An ε that can only take energy out: the gradient by velocity of a dissipation function R(q, v).

Every body that moves through a medium, or in a simulator with damped links, and every joint with friction adds a term
to R that grows with its speed, so ε = ∂R/∂v opposes the motion and is odd in v: it can be neither H a, nor c, nor g.
R is carried along the chain as the kinetic energy of `delan` is: x is the speed that velocity gives a body, and
R = Σ ½ |B x|² + ⅓ |C x|³ over bodies, plus ½ d v² + f |v| over joints: linear and quadratic drag, viscous and dry
friction (blurred about zero). The quadratic form is Rayleigh's (1873).
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
from lagnet.models.lagrangian import Scalar, Vector
from lagnet.models.scales import Scales
from lagnet.models.torque_network import SLOW

SMALL = 1e-6  # of a typical speed squared: rounds the tip of |C x|³, whose slope of slope is not defined there


@dataclass(frozen=True)
class DissipationSettings:
    """Size of the chain network: length of the state that carries velocity outwards."""

    rank: int = 12

    def __post_init__(self) -> None:
        if not 1 <= self.rank <= 256:
            raise ModelError(f"rank is {self.rank}, expected 1 … 256")


class DissipationNetwork(eqx.Module):
    """ε = ∂R/∂v, each joint times its share.

    Args:
        motion: carries velocity outwards; axes: shape (dof, rank), what unit speed of each joint adds.
        linear, cubic: one (rank, rank) matrix a joint, B and C.
        viscous, dry: shape (dof,), roots of d and f of each joint.
        shares: shape (dof,), what of ε counts on each joint; not trained, 1 unless held-out torque bears out less. With
            different shares v · ε may be negative.
    """

    motion: ChainNetwork
    axes: Array
    linear: Array
    cubic: Array
    viscous: Array
    dry: Array
    shares: Array
    features: JointFeatures = eqx.field(static=True)
    scales: Scales = eqx.field(static=True)
    settings: DissipationSettings = eqx.field(static=True)

    def dissipation(self, q: Vector, v: Vector) -> Scalar:
        """R(q, v) in units of torque times speed of each joint."""
        speed = v / np.asarray(self.scales.velocity, v.dtype)
        states = self.motion(self.features(q), jnp.zeros_like(self.axes[0]), tuple(self.axes * speed[:, None]))
        power = np.asarray(self.scales.torque) * np.asarray(self.scales.velocity)
        total = jnp.zeros_like(speed, shape=())
        for x, one, two, size in zip(states, self.linear, self.cubic, power.tolist(), strict=True):
            drag = jnp.sum((two @ x) ** 2) + SMALL
            total += size * (0.5 * jnp.sum((one @ x) ** 2) + drag * jnp.sqrt(drag) / 3.0)
        joints = 0.5 * self.viscous**2 * speed**2 + self.dry**2 * SLOW * _log_cosh(speed / SLOW)
        return total + jnp.sum(power.astype(v.dtype) * joints)

    def __call__(self, q: Vector, v: Vector, a: Vector) -> Vector:
        """Torque at one sample, shape (dof,) [N m]; a is not looked at."""
        return jax.lax.stop_gradient(self.shares) * jax.grad(self.dissipation, argnums=1)(q, v)

    def scaled(self, shares: np.ndarray) -> DissipationNetwork:
        """The same with the torque of each joint times its share, shape (dof,)."""
        return eqx.tree_at(lambda x: x.shares, self, self.shares * shares.astype(self.shares.dtype))


def _log_cosh(x: Array) -> Array:
    """ln cosh x without overflow, whose slope is tanh x."""
    return jax.nn.softplus(2.0 * x) - x - np.log(2.0)


def make_dissipation(
    key: Array, features: JointFeatures, scales: Scales, settings: DissipationSettings
) -> DissipationNetwork:
    """Draw an untrained network that takes little."""
    n, rank = len(features.joint_types), settings.rank
    keys, size = jax.random.split(key, 4), 0.3 / (np.sqrt(n) * rank)
    small, one = 0.1 * jnp.ones(n), jnp.ones(n)
    return DissipationNetwork(
        motion=make_chain_network(keys[0], features.owner, n, rank),
        axes=jax.random.normal(keys[1], (n, rank)),
        linear=size * jax.random.normal(keys[2], (n, rank, rank)),
        cubic=size * jax.random.normal(keys[3], (n, rank, rank)),
        viscous=small,
        dry=small,
        shares=one,
        features=features.on_circle,
        scales=scales,
        settings=settings,
    )
