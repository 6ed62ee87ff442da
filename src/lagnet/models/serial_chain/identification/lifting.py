"""A relaxation of the serial arm in which only the directions of the joint axes are nonlinear.

A mass point of any link lies at r = Σ_μ c_μ y_μ(q), where the y_μ are the x and y columns of each revolute link's
rotation (its z column is fixed in the link before) and q z of each prismatic joint; lengths hide in the constants c.
The kinetic energy is then ½ Σ Ω_μν ẏ_μ·ẏ_ν with Ω = ∫ c cᵀ dm, gravity does the same with three constant base
vectors, and by Lagrange's equations each pair adds Ω_μν (∂y_μ/∂q · ÿ_ν + ∂y_ν/∂q · ÿ_μ) to the torque: linear in Ω.
Every arm with these axis directions is some Ω, so link lengths, gravity and inertias all drop out of the search: 26
nonlinear unknowns of a seven-joint arm become 11, and about every third random start finds them. Ω is not kept.
The linearity is that of barycentric parameters (Maes, Samin & Willems 1989).
"""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from lagnet.models.serial_chain.mechanics.kinematics import turning


def lifted_regressor(angles: Array, revolute: tuple[bool, ...], q: Array, v: Array, a: Array) -> Array:
    """Torque per unit of each entry of Ω: shape (dof, pairs of moving vectors + 3 × moving vectors)."""
    jacobian, second = _moving_vectors(angles, revolute, q, v, a)
    rows, columns = np.triu_indices(second.shape[0])
    pairs = jnp.einsum("mkx,tx->kmt", jacobian, second)
    inertial = pairs[:, rows, columns] + pairs[:, columns, rows]
    weight = jnp.swapaxes(jacobian, 0, 1).reshape(len(revolute), -1)
    return jnp.concatenate([inertial, weight], axis=1)


def gravity_direction(lifted: np.ndarray, revolute: tuple[bool, ...]) -> np.ndarray:
    """Unit vector along gravity in the base frame, up to sign: Ω's weight part is gravity times first moments."""
    weight = lifted[-3 * _count(revolute) :].reshape(-1, 3)
    return np.linalg.svd(weight)[2][0]


def _count(revolute: tuple[bool, ...]) -> int:
    return sum(2 if turns else 1 for turns in revolute)


def _moving_vectors(angles: Array, revolute: tuple[bool, ...], q: Array, v: Array, a: Array) -> tuple[Array, Array]:
    """Jacobians (vectors, dof, 3) and second derivatives (vectors, 3) of the y_μ."""
    turned = turning(angles, revolute, q, v, a)
    owner = np.array([i for i, turns in enumerate(revolute) for _ in range(2 if turns else 1)])
    rotations = [
        turned.rotation[i, :, c] if t else turned.slide[i] for i, t in enumerate(revolute) for c in range(1 + t)
    ]
    seconds = [
        turned.second[i, :, c] if t else turned.slide_second[i] for i, t in enumerate(revolute) for c in range(1 + t)
    ]
    carried = jnp.cross(turned.axis[None], jnp.stack(rotations)[:, None])
    turns = np.asarray(revolute)
    joints = np.arange(len(revolute))
    carries = (joints[None] <= owner[:, None]) & turns[None]
    slides = (joints[None] == owner[:, None]) & ~turns[None]
    jacobian = jnp.where(carries[..., None], carried, jnp.where(slides[..., None], turned.axis[None], 0.0))
    return jacobian, jnp.stack(seconds)
