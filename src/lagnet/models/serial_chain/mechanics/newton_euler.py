"""Torques, mass matrix and energies of a serial arm of known constants; one sample, pure JAX.

Newton–Euler in the base frame: each link's inertia times the accelerations of its vectors gives the force and the
moment it needs; these add up from the tip to the base, and each joint bears the component along its axis. The mass
matrix adds up pseudo-inertias instead (composite bodies). Source: Luh, Walker & Paul 1980; Featherstone 2008, ch. 6.
"""

from __future__ import annotations

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array

from lagnet.models.lagrangians.lagrangian import AbstractLagrangian, Matrix, Scalar, Vector
from lagnet.models.serial_chain.mechanics.inertia import COLUMNS, OFF_DIAGONAL, ROWS, pseudo_inertia
from lagnet.models.serial_chain.mechanics.kinematics import FrameMotion, Geometry, frame_jacobian, frame_motion


class SerialArm(AbstractLagrangian):
    """A chain of rigid links: shape, ten moments a link, and the inertia of each rotor about its own axis.

    Args:
        geometry: constants of the arm's shape.
        moments: shape (dof, 10), entries of each link's pseudo-inertia in its own frame.
        rotor_inertia: shape (dof,), added to the diagonal of the mass matrix [kg m²] ([kg] on prismatic joints).
        revolute: which joints turn.
    """

    geometry: Geometry
    moments: Array
    rotor_inertia: Array
    revolute: tuple[bool, ...] = eqx.field(static=True)

    def kinetic_energy(self, q: Vector, v: Vector) -> Scalar:
        return 0.5 * v @ self.mass_matrix(q) @ v

    def potential_energy(self, q: Vector) -> Scalar:
        first = jnp.einsum("iax,ia->x", self._at(q).vectors, pseudo_inertia(self.moments)[:, 3])
        return -self.geometry.gravity @ first

    def momentum(self, q: Vector, v: Vector) -> Vector:
        return self.mass_matrix(q) @ v

    def mass_matrix(self, q: Vector) -> Matrix:
        motion = self._at(q)
        shape = _homogeneous(motion.vectors)
        composite = jnp.cumsum((shape @ pseudo_inertia(self.moments) @ jnp.swapaxes(shape, 1, 2))[::-1], axis=0)[::-1]
        twist = _twists(motion, self.revolute)
        upper = jnp.triu(jnp.einsum("ixb,kbc,kxc->ik", twist, composite, twist))
        return upper + jnp.triu(upper, 1).T + jnp.diag(self.rotor_inertia)

    def inverse_dynamics(self, q: Vector, v: Vector, a: Vector) -> Vector:
        """Torque [N m] that gives acceleration a at (q, v)."""
        motion = frame_motion(self.geometry, self.revolute, q, v, a)
        needed = jnp.einsum("iab,ibx->iax", pseudo_inertia(self.moments), motion.second)
        force = jnp.cumsum(needed[::-1, 3], axis=0)[::-1]
        moment = jnp.cumsum(jnp.cross(motion.vectors, needed).sum(1)[::-1], axis=0)[::-1]
        about_joint = moment - jnp.cross(motion.vectors[:, 3], force)
        borne = jnp.where(jnp.asarray(self.revolute)[:, None], about_joint, force)
        return jnp.sum(motion.axis * borne, axis=1) + self.rotor_inertia * a

    def _at(self, q: Vector) -> FrameMotion:
        return frame_motion(self.geometry, self.revolute, q, jnp.zeros_like(q), jnp.zeros_like(q))


def moment_regressor(geometry: Geometry, revolute: tuple[bool, ...], q: Vector, v: Vector, a: Vector) -> Array:
    """Torque per unit of each link's moments, shape (dof, 10 dof): torque is this times the stacked moments."""
    motion = frame_motion(geometry, revolute, q, v, a)
    pairs = jnp.einsum("iakx,ibx->kiab", frame_jacobian(motion, revolute), motion.second)
    columns = pairs[..., ROWS, COLUMNS] + jnp.where(OFF_DIAGONAL, pairs[..., COLUMNS, ROWS], 0.0)
    return columns.reshape(len(revolute), -1)


def _homogeneous(vectors: Array) -> Array:
    """Links' vectors (dof, 4, 3) as 4 × 4 transformation matrices."""
    last = jnp.broadcast_to(jnp.array([0.0, 0.0, 0.0, 1.0]), (vectors.shape[0], 1, 4))
    return jnp.concatenate([jnp.swapaxes(vectors, 1, 2), last.astype(vectors.dtype)], axis=1)


def _twists(motion: FrameMotion, revolute: tuple[bool, ...]) -> Array:
    """How each joint moves a point given in homogeneous coordinates, shape (dof, 3, 4)."""
    turned = jnp.cross(motion.axis[:, None], jnp.eye(3)[None])
    turned = jnp.concatenate([turned, -jnp.cross(motion.axis, motion.vectors[:, 3])[:, None]], axis=1)
    slid = jnp.zeros_like(turned).at[:, 3].set(motion.axis)
    return jnp.swapaxes(jnp.where(jnp.asarray(revolute)[:, None, None], turned, slid), 1, 2)
