"""How the unknowns of a serial arm are laid out in vectors, and the two problems they enter: relaxed and full."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from lagnet.models.serial_chain.identification.lifting import lifted_regressor
from lagnet.models.serial_chain.mechanics.joint_terms import joint_term_columns
from lagnet.models.serial_chain.mechanics.kinematics import Geometry
from lagnet.models.serial_chain.mechanics.newton_euler import moment_regressor
from lagnet.models.serial_chain.settings import STANDARD_GRAVITY

ORDINARY_LENGTH = 0.3  # [m]


@dataclass(frozen=True)
class Unknowns:
    """The joints at hand and which constants describe them.

    Args:
        revolute: which joints turn.
        joint_terms: names of the terms that each joint adds.
        slow_speed: speed of each joint below which Coulomb friction fades [rad/s].
    """

    revolute: tuple[bool, ...]
    joint_terms: tuple[str, ...]
    slow_speed: tuple[float, ...]

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        return len(self.revolute)

    @property
    def n_angles(self) -> int:
        """Unknown angles between joint axes; the first turn about z is a choice of base frame."""
        return max(2 * self.n_dof - 3, 0)

    @property
    def relaxed_size(self) -> int:
        """Linear unknowns of the relaxed problem, without joint terms."""
        moving = sum(2 if turns else 1 for turns in self.revolute)
        return moving * (moving + 1) // 2 + 3 * moving

    @property
    def scale(self) -> np.ndarray:
        """Typical size of each nonlinear unknown of the full problem: angles 1 rad, offsets 1 m, gravity 10 m/s²."""
        return np.concatenate([np.ones(self.n_angles + 2 * (self.n_dof - 1)), np.full(3, 10.0)])

    def angles(self, x: Array) -> Array:
        """The leading entries of x as angles (dof − 1, 2)."""
        first = jnp.zeros(min(self.n_dof - 1, 1), x.dtype)
        return jnp.concatenate([first, x[: self.n_angles]]).reshape(-1, 2)

    def geometry(self, x: Array) -> Geometry:
        """Nonlinear unknowns of the full problem as an arm's shape."""
        return Geometry(self.angles(x), x[self.n_angles : -3].reshape(-1, 2), x[-3:])

    def reach(self, x: Array) -> Array:
        """Offsets in units of an ordinary arm's, whatever the unit of length that gravity's size implies.

        Lengths and first moments enter the torque mostly as products, so noise leaves valleys along which a link grows
        and its moments shrink; a penalty on this vector picks the shortest arm there.
        """
        size = jnp.linalg.norm(x[-3:])
        unit = jnp.where(size > 0, STANDARD_GRAVITY / size, 1.0) / ORDINARY_LENGTH
        return x[self.n_angles : -3] * unit

    def flatten(self, geometry: Geometry) -> np.ndarray:
        """The inverse of `geometry`."""
        return np.concatenate([np.ravel(geometry.angles)[1:], np.ravel(geometry.offsets), np.asarray(geometry.gravity)])

    def relaxed_design(self, x: Array, q: Array, v: Array, a: Array) -> Array:
        """Torque per linear unknown when only the axis directions x are given."""
        return self._with_terms(lifted_regressor(self.angles(x), self.revolute, q, v, a), q, v, a)

    def full_design(self, x: Array, q: Array, v: Array, a: Array) -> Array:
        """Torque per moment of each link, then per joint-term coefficient, when the shape x is given."""
        return self._with_terms(moment_regressor(self.geometry(x), self.revolute, q, v, a), q, v, a)

    def torque(self, x: np.ndarray, w: np.ndarray, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> Array:
        """Torque (n, dof) of all linear unknowns w at shape x."""
        return _torque(self, jnp.asarray(x), jnp.asarray(w), jnp.asarray(q), jnp.asarray(v), jnp.asarray(a))

    def _with_terms(self, columns: Array, q: Array, v: Array, a: Array) -> Array:
        return jnp.concatenate(
            [columns, joint_term_columns(self.joint_terms, jnp.asarray(self.slow_speed), q, v, a)], axis=1
        )


@partial(jax.jit, static_argnums=0)
def _torque(unknowns: Unknowns, x: Array, w: Array, q: Array, v: Array, a: Array) -> Array:
    return jax.lax.map(lambda s: unknowns.full_design(x, *s) @ w, (q, v, a), batch_size=500)


def normalise_gravity(unknowns: Unknowns, x: np.ndarray, moments: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Give gravity its standard size by choosing the unit of length, which turning joints alone leave open.

    Lengths times s, first moments divided by s and masses by s² leave every torque as it is when gravity is multiplied
    by s; with a prismatic joint the metre is known and gravity is measured instead.
    """
    size = float(np.linalg.norm(x[-3:]))
    if not all(unknowns.revolute) or size == 0.0:
        return x, moments
    s = STANDARD_GRAVITY / size
    x, moments = x.copy(), moments.copy()
    x[unknowns.n_angles :] *= s
    moments[:, 6:9] /= s
    moments[:, 9] /= s**2
    return x, moments
