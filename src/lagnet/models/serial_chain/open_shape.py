"""Where joint axes may lie without that the torque of the arm would tell, and the same arm with its axes elsewhere.

A body balanced about its joint's axis bears on the joints before it like a point mass on that axis: the torque of the
bare arm does not say where the axis is. A load behind it does. Moments of the links make up for each move of the
offsets, so that the arm moved gives the same torque. Source: Gautier & Khalil 1990 (which constants torque holds);
Atkeson et al. 1986 (loads).
"""

from __future__ import annotations

from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from lagnet.models.learned_model import LearnedModel
from lagnet.models.serial_chain.identification.unknowns import ORDINARY_LENGTH
from lagnet.models.serial_chain.mechanics.kinematics import Geometry
from lagnet.models.serial_chain.mechanics.newton_euler import moment_regressor
from lagnet.models.serial_chain.model import SerialChain

MOTIONS = 400  # random states at which two arms are the same if their torques are
INDEPENDENT = 50  # of those states, what the learned arm misses counts as so many: it is a shape, not noise
KNOWN = 1e-3  # [m] a direction in which torque holds the axes to this needs no load to be found
RANK = 1e-8  # of the largest singular value, columns scaled to one


class OpenShape:
    """The offsets of a learned arm that its torque leaves open.

    Args:
        chain: the learned arm.
        missed: shape (dof,), torque that it is known to miss, root mean square [N m].
        seed: of the states at which torques are compared.
    """

    def __init__(self, chain: SerialChain, missed: np.ndarray, seed: int = 0):
        self.chain = chain
        self.arm = chain.dynamics.lagrangian
        self._states = _random_states(chain, seed)
        self._moments = np.asarray(self.arm.moments, dtype=float)
        with jax.enable_x64(True):
            self.directions, self.sureness = self._open(np.maximum(missed, 1e-12))

    def reach(self, move: np.ndarray) -> np.ndarray:
        """The offsets moved, in units of an ordinary arm's, shape (2 (dof − 1),): what nothing tells is kept short."""
        return (np.asarray(self.arm.geometry.offsets).ravel() + self.directions @ move) / ORDINARY_LENGTH

    def last_link(self, move: np.ndarray, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        """Torque per unit of each moment of the last link, axes moved along the open directions, (n, dof, 10)."""
        with jax.enable_x64(True):
            return np.asarray(_regressor(self.arm.revolute, self._moved(move), q, v, a))[:, :, -10:]

    def moved(self, move: np.ndarray) -> SerialChain:
        """The arm that gives the same torque with its axes elsewhere; its links need not be such as can exist.

        Args:
            move: shape (directions,) [m].
        """
        with jax.enable_x64(True):
            geometry = self._moved(move)
            there = _flat(_regressor(self.arm.revolute, geometry, *self._states))
            torque = _flat(_regressor(self.arm.revolute, self.arm.geometry, *self._states)) @ self._moments.ravel()
            size = _sizes(there)
            lacks = torque - there @ self._moments.ravel()
            made_up = np.linalg.lstsq(there / size, lacks, rcond=RANK)[0] / size
            moments = jnp.asarray(self._moments + made_up.reshape(self._moments.shape))
        parts = (geometry.offsets, moments)
        dynamics = eqx.tree_at(lambda d: (d.lagrangian.geometry.offsets, d.lagrangian.moments), self._double(), parts)
        about = self.chain.training | {"axes_put_by_load": True}
        return SerialChain(LearnedModel(self.chain.spec, dynamics, about))

    def _double(self):
        return jax.tree.map(lambda x: jnp.asarray(x) if eqx.is_array(x) else x, self.chain.dynamics)

    def _moved(self, move: np.ndarray) -> Geometry:
        geometry = self.arm.geometry
        step = (self.directions @ move).reshape(geometry.offsets.shape)
        return geometry._replace(offsets=jnp.asarray(np.asarray(geometry.offsets) + step))

    def _open(self, missed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Directions of the offsets, (offsets, k), that moments can make up for, and 1 / deviation of each [1/m]."""
        columns = _regressor(self.arm.revolute, self.arm.geometry, *self._states) / missed[None, :, None]
        slopes = _slopes(self.arm.revolute, self.arm.geometry, jnp.asarray(self._moments.ravel()), *self._states)
        columns, slopes = _flat(columns), _flat(np.asarray(slopes) / missed[:, None])
        left, values, _ = np.linalg.svd(columns / _sizes(columns), full_matrices=False)
        made_up = left[:, values > RANK * values[0]]
        rest = slopes - made_up @ (made_up.T @ slopes)
        share = INDEPENDENT / len(self._states[0])
        held, directions = np.linalg.eigh(share * rest.T @ rest)
        sureness = np.sqrt(np.maximum(held, 0.0))
        is_open = sureness < 1.0 / KNOWN
        return directions[:, is_open], sureness[is_open]


def _random_states(chain: SerialChain, seed: int) -> tuple[np.ndarray, ...]:
    """Positions all around (sliding joints within a metre), speeds and accelerations of the sizes that were seen."""
    rng = np.random.default_rng(seed)
    shape = (MOTIONS, chain.n_dof)
    revolute = np.asarray(chain.dynamics.lagrangian.revolute)
    q = np.where(revolute, np.pi, 0.5) * rng.uniform(-1.0, 1.0, shape) + np.where(revolute, 0.0, _middle(chain))
    scales = chain.spec.scales
    return q, rng.normal(size=shape) * scales.velocity, rng.normal(size=shape) * scales.acceleration


def _middle(chain: SerialChain) -> np.ndarray:
    return np.asarray(chain.spec.features.centre)


def _flat(columns: np.ndarray | Array) -> np.ndarray:
    return np.asarray(columns).reshape(-1, columns.shape[-1])


def _sizes(columns: np.ndarray) -> np.ndarray:
    size = np.linalg.norm(columns, axis=0)
    return np.where(size > 0, size, 1.0)


@partial(jax.jit, static_argnums=0)
def _regressor(revolute: tuple[bool, ...], geometry: Geometry, q: Array, v: Array, a: Array) -> Array:
    return jax.lax.map(lambda s: moment_regressor(geometry, revolute, *s), (q, v, a), batch_size=500)


@partial(jax.jit, static_argnums=0)
def _slopes(revolute: tuple[bool, ...], geometry: Geometry, moments: Array, q: Array, v: Array, a: Array) -> Array:
    """Change of the torque with each offset, shape (n, dof, offsets)."""

    def torque(offsets: Array, *state: Array) -> Array:
        moved = geometry._replace(offsets=offsets.reshape(geometry.offsets.shape))
        return moment_regressor(moved, revolute, *state) @ moments

    slope = jax.jacfwd(torque)
    return jax.lax.map(lambda s: slope(geometry.offsets.ravel(), *s), (q, v, a), batch_size=100)
