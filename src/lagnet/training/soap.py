"""SOAP: Adam in the slowly turning eigenbasis of each weight matrix's gradient covariance.

Curvature-aware at the price of a few small matrix products a step; on these smooth, noise-free regressions it needs several
times fewer steps than Adam. Source: Vyas et al. 2024 (SOAP), after Gupta et al. 2018 (Shampoo).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import optax
from jaxtyping import Array


class Basis(NamedTuple):
    """Gradient covariances of one matrix from the left and the right, and their eigenvectors."""

    left: Array
    right: Array
    left_vectors: Array
    right_vectors: Array


class SoapState(NamedTuple):
    """Step count, both Adam moments (first in the weights' space, second in the eigenbasis) and one Basis a matrix."""

    count: Array
    first: Any
    second: Any
    bases: tuple[Basis | None, ...]


def scale_by_soap(
    b1: float = 0.95, b2: float = 0.99, eps: float = 1e-12, every: int = 10
) -> optax.GradientTransformation:
    """Update direction of SOAP.

    Args:
        b1, b2: memory of the first and second moments; b2 also of the covariances.
        eps: added to the root of the second moment.
        every: steps between turns of the eigenbasis (one QR step of orthogonal iteration).
    """

    def init(params: Any) -> SoapState:
        zeros = jax.tree.map(jnp.zeros_like, params)
        return SoapState(jnp.zeros((), jnp.int32), zeros, zeros, tuple(map(_empty_basis, jax.tree.leaves(params))))

    def update(grads: Any, state: SoapState, params: Any = None) -> tuple[Any, SoapState]:
        count = state.count + 1
        leaves, tree = jax.tree.flatten(grads)
        turn = (count % every == 1) | (every == 1)
        out = [
            _leaf_update(g, m, s, basis, count, turn, (b1, b2, eps))
            for g, m, s, basis in zip(
                leaves, jax.tree.leaves(state.first), jax.tree.leaves(state.second), state.bases, strict=True
            )
        ]
        steps, first, second, bases = zip(*out, strict=True)
        restore = tree.unflatten
        return restore(steps), SoapState(count, restore(first), restore(second), tuple(bases))

    return optax.GradientTransformation(init, update)


def _empty_basis(leaf: Array) -> Basis | None:
    if leaf.ndim != 2 or 1 in leaf.shape:
        return None
    rows, columns = (jnp.eye(size, dtype=leaf.dtype) for size in leaf.shape)
    return Basis(jnp.zeros_like(rows), jnp.zeros_like(columns), rows, columns)


def _leaf_update(grad, first, second, basis, count, turn, memory):
    """One leaf's step; without a basis this is Adam."""
    b1, b2, eps = memory
    first = b1 * first + (1 - b1) * grad
    if basis is not None:
        basis = _follow(basis, grad, turn, b2)
    second = b2 * second + (1 - b2) * _rotate(grad, basis) ** 2
    root = jnp.sqrt(second / (1 - b2**count)) + eps
    step = _rotate(first / (1 - b1**count), basis) / root
    return _rotate_back(step, basis), first, second, basis


def _rotate(x: Array, basis: Basis | None) -> Array:
    return x if basis is None else basis.left_vectors.T @ x @ basis.right_vectors


def _rotate_back(x: Array, basis: Basis | None) -> Array:
    return x if basis is None else basis.left_vectors @ x @ basis.right_vectors.T


def _follow(basis: Basis, grad: Array, turn: Array, b2: float) -> Basis:
    """Let the covariances take in the gradient and, every few steps, turn the eigenvectors after them."""
    left = b2 * basis.left + (1 - b2) * grad @ grad.T
    right = b2 * basis.right + (1 - b2) * grad.T @ grad

    def turned(_):
        return jnp.linalg.qr(left @ basis.left_vectors)[0], jnp.linalg.qr(right @ basis.right_vectors)[0]

    vectors = jax.lax.cond(turn, turned, lambda _: (basis.left_vectors, basis.right_vectors), None)
    return Basis(left, right, *vectors)
