"""Where the link frames of a serial arm are and how they accelerate, in the frame of the base.

Frame 0 turns about or slides along the base's z axis. Frame i + 1 sits at `offsets[i]` in the x–y plane of frame i and
is turned by Rz(angles[i, 0]) Rx(angles[i, 1]). Two angles and two lengths a joint suffice: an origin may lie anywhere
along its own axis, so it is put where the next origin has no z component; a turn about the next joint's axis only
shifts that joint's zero, which changes inertial parameters, not motion; the first turn about z is a choice of base.

Every link carries four vectors: the columns x, y, z of its rotation and its origin. A point of the link is a constant
combination of them, so their Jacobians and second derivatives are all that dynamics needs. Source: Uicker 1965;
Hollerbach 1980 (4 × 4 matrices); Denavit & Hartenberg 1955 (counting of constants).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from lagnet.errors import ModelError

JOINT_TYPES = ("revolute", "continuous", "prismatic")


class Geometry(NamedTuple):
    """The constants of an arm's shape.

    Args:
        angles: shape (dof − 1, 2), turn θ about z, then α about x, to the next joint's frame [rad].
        offsets: shape (dof − 1, 2), origin of the next frame along x and y [m].
        gravity: shape (3,), acceleration of free fall in the base frame [m/s²].
    """

    angles: Float[Array, "links 2"]
    offsets: Float[Array, "links 2"]
    gravity: Float[Array, " 3"]


class Turning(NamedTuple):
    """Orientation of every link and its second time derivative, with the vectors along which prismatic joints slide.

    Args:
        rotation: R, shape (dof, 3, 3), columns in the base frame.
        second: d²R/dt², shape (dof, 3, 3) [1/s²].
        axis: joint axes z, shape (dof, 3).
        slide: q z of prismatic joints, zero for revolute ones, shape (dof, 3) [m].
        slide_second: its second time derivative, shape (dof, 3) [m/s²].
    """

    rotation: Array
    second: Array
    axis: Array
    slide: Array
    slide_second: Array


class FrameMotion(NamedTuple):
    """The four vectors of every link (columns x, y, z and the origin), with their second derivatives.

    Args:
        vectors: shape (dof, 4, 3), vectors[:, 3] is the origin [m].
        second: shape (dof, 4, 3); gravity is taken off the origin's acceleration, as if the base accelerated upwards.
        axis: joint axes, shape (dof, 3).
    """

    vectors: Array
    second: Array
    axis: Array


def revolute_mask(joint_types: Sequence[str]) -> tuple[bool, ...]:
    """Which joints turn.

    Raises:
        ModelError: a joint type is unknown, or there is no joint.
    """
    if not joint_types:
        raise ModelError("a serial chain needs at least one joint")
    for index, kind in enumerate(joint_types):
        if kind not in JOINT_TYPES:
            raise ModelError(f"joint type {kind!r} is unknown", where=f"joint {index}", choices=JOINT_TYPES)
    return tuple(kind != "prismatic" for kind in joint_types)


def turning(angles: Array, revolute: tuple[bool, ...], q: Array, v: Array, a: Array) -> Turning:
    """Follow the orientation of the links from the base outwards; q, v, a of shape (dof,)."""
    frame, omega, omega_dot = jnp.eye(3), jnp.zeros(3), jnp.zeros(3)
    rotations, seconds, axes, slides, slide_seconds = [], [], [], [], []
    for i, turns in enumerate(revolute):
        if i:
            frame = frame @ (_about_z(angles[i - 1, 0]) @ _about_x(angles[i - 1, 1]))
        axis = frame[:, 2]
        axes.append(axis)
        slide, slide_second = jnp.zeros(3), jnp.zeros(3)
        if turns:
            omega_dot = omega_dot + axis * a[i] + jnp.cross(omega, axis) * v[i]
            omega = omega + axis * v[i]
            frame = frame @ _about_z(q[i])
        else:
            slide = q[i] * axis
            slide_second = a[i] * axis + 2 * v[i] * jnp.cross(omega, axis) + _spin(omega, omega_dot) @ slide
        rotations.append(frame)
        seconds.append(_spin(omega, omega_dot) @ frame)
        slides.append(slide)
        slide_seconds.append(slide_second)
    return Turning(*map(jnp.stack, (rotations, seconds, axes, slides, slide_seconds)))


def frame_motion(geometry: Geometry, revolute: tuple[bool, ...], q: Array, v: Array, a: Array) -> FrameMotion:
    """The vectors of every link and their accelerations at one state; q, v, a of shape (dof,)."""
    turned = turning(geometry.angles, revolute, q, v, a)
    origin = _origins(turned.rotation, turned.slide, geometry.offsets)
    origin_second = _origins(turned.second, turned.slide_second, geometry.offsets) - geometry.gravity[None, :]
    return FrameMotion(
        jnp.concatenate([jnp.swapaxes(turned.rotation, 1, 2), origin[:, None]], axis=1),
        jnp.concatenate([jnp.swapaxes(turned.second, 1, 2), origin_second[:, None]], axis=1),
        turned.axis,
    )


def frame_jacobian(motion: FrameMotion, revolute: tuple[bool, ...]) -> Float[Array, "dof 4 dof 3"]:
    """How each vector of each link (first two dimensions) moves with each joint (third)."""
    n = len(revolute)
    origins = motion.vectors[:, 3]
    arms = motion.vectors[:, :, None] - jnp.zeros((1, 4, n, 3)).at[:, 3].set(origins)
    turned = jnp.cross(motion.axis[None, None], arms)
    slid = jnp.zeros((1, 4, n, 3)).at[:, 3].set(motion.axis)
    moved = jnp.where(jnp.asarray(revolute)[None, None, :, None], turned, slid)
    return jnp.where(jnp.tri(n, dtype=bool)[:, None, :, None], moved, 0.0)


def _origins(rotation: Array, slide: Array, offsets: Array) -> Array:
    """Sum links and slides from the base outwards; linear, so it serves positions and accelerations alike."""
    steps = jnp.einsum("ixy,iy->ix", rotation[:-1, :, :2], offsets)
    return jnp.cumsum(slide.at[1:].add(steps), axis=0)


def _spin(omega: Array, omega_dot: Array) -> Array:
    """The matrix that turns a body-fixed vector into its second derivative: [ω̇]× + [ω]×²."""
    x, y, z = omega_dot
    across = jnp.stack([jnp.stack([0 * x, -z, y]), jnp.stack([z, 0 * x, -x]), jnp.stack([-y, x, 0 * x])])
    return across + omega[:, None] * omega[None, :] - (omega @ omega) * jnp.eye(3)


def _about_z(angle: Array) -> Array:
    c, s = jnp.cos(angle), jnp.sin(angle)
    zero, one = jnp.zeros_like(c), jnp.ones_like(c)
    return jnp.stack([jnp.stack([c, -s, zero]), jnp.stack([s, c, zero]), jnp.stack([zero, zero, one])])


def _about_x(angle: Array) -> Array:
    c, s = jnp.cos(angle), jnp.sin(angle)
    zero, one = jnp.zeros_like(c), jnp.ones_like(c)
    return jnp.stack([jnp.stack([one, zero, zero]), jnp.stack([zero, c, -s]), jnp.stack([zero, s, c])])
