"""An ε of drag on the bodies whose motion mechanics carry already, and friction in every joint.

The same law as in `dissipation`, but what moves against the medium are the bodies of the mechanics themselves: their
`motion` along the chain is not learned a second time. Half the weights that shape velocities are then saved, and
mechanics and drag agree on them from the first step.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from lagnet.errors import ModelError
from lagnet.models.features import JointFeatures
from lagnet.models.lagrangians.conservative import Conservative
from lagnet.models.lagrangians.delan import Delan
from lagnet.models.lagrangians.lagrangian import Vector
from lagnet.models.residuals.augmented import Augmented
from lagnet.models.residuals.dissipation import LITTLE, draw_roots, wrench_of
from lagnet.models.residuals.torque_network import SLOW
from lagnet.models.scales import Scales


@dataclass(frozen=True)
class BodyDragSettings:
    """Number of drags of a body that grow with a speed of it: two would do for translation and turning."""

    drags: int = 4

    def __post_init__(self) -> None:
        if not 1 <= self.drags <= 64:
            raise ModelError(f"drags is {self.drags}, expected 1 … 64")


class BodyDrag(eqx.Module):
    """Drag of bodies whose motion is given, and friction; each joint times its share.

    Args:
        linear: shape (dof, rank, rank), B of each body.
        speeds, quadratic: shape (drags, dof, rank, rank), S_k and C_k of each body.
        viscous, dry: shape (dof,), roots of viscous and dry friction of each joint.
        shares: shape (dof,), what of ε counts on each joint; not trained.
    """

    linear: Array
    speeds: Array
    quadratic: Array
    viscous: Array
    dry: Array
    shares: Array
    scales: Scales = eqx.field(static=True)
    settings: BodyDragSettings = eqx.field(static=True)

    def torque(self, arm: Delan, q: Vector, v: Vector) -> Vector:
        """Torque at one sample, shape (dof,) [N m], on the bodies that `arm` carries."""
        size = np.asarray(self.scales.velocity, v.dtype)
        force, typical = np.asarray(self.scales.torque, v.dtype), size.mean()
        features = arm.features(q)

        def motion(speed: Vector) -> Array:
            entries = tuple(arm.axes * speed[:, None])
            return jnp.stack(arm.motion(features, jnp.zeros_like(arm.axes[0]), entries)) / typical

        x, virtual_work = jax.vjp(motion, v)
        wrench = wrench_of(self.linear, self.speeds, self.quadratic, x)
        friction = self.viscous**2 * v / size + self.dry**2 * jnp.tanh(v / size / SLOW)
        total = virtual_work((force * size)[:, None] * wrench)[0] + force * friction
        return jax.lax.stop_gradient(self.shares) * total

    def scaled(self, shares: np.ndarray) -> BodyDrag:
        """The same with the torque of each joint times its share, shape (dof,)."""
        return eqx.tree_at(lambda x: x.shares, self, self.shares * shares.astype(self.shares.dtype))


class Dragged(Augmented):
    """DeLaN whose bodies are dragged: ε acts on the motion that mechanics carry, and cannot be without them."""

    mechanics: Conservative
    residual: BodyDrag

    def epsilon(self, q: Vector, v: Vector, a: Vector) -> Vector:
        assert isinstance(self.mechanics.lagrangian, Delan)
        return self.residual.torque(self.mechanics.lagrangian, q, v)


def make_dragged(
    mechanics: Any, parity: str, key: Array, features: JointFeatures, scales: Scales, settings: BodyDragSettings
) -> Dragged:
    """Untrained drag that takes little, on mechanics of the kind `delan`; it is odd whatever the parity asked."""
    n, rank = mechanics.lagrangian.axes.shape
    linear, speeds, quadratic = draw_roots(jax.random.split(key, 3), n, rank, settings.drags)
    little = LITTLE * jnp.ones(n)
    drag = BodyDrag(linear, speeds, quadratic, little, little, jnp.ones(n), scales, settings)
    return Dragged(mechanics, drag, parity)
