"""A network that follows the arm: a state travels from joint to joint, transformed by a matrix linear in features.

Perceptrons must learn products of sines and cosines of up to all joints from samples; here the products are what the
network is made of. With one matrix per joint, x → (W₀ + Σ_f φ_f(q_k) W_f) x, the state after joint k is a polynomial of
degree one in the features of each joint, which is how velocities and gravity pass through a chain of bodies. The
matrices are free, so offsets, axes and what hangs on the links are learned, none is given.
"""

from __future__ import annotations

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array


class ChainNetwork(eqx.Module):
    """Transfer matrices along the joints, one (rank, rank · (1 + n_features of the joint)) a joint.

    Args:
        transfers: one matrix a joint, first the constant part, then one part a feature.
        owner: the joint that each feature comes from, ascending.
    """

    transfers: tuple[Array, ...]
    owner: tuple[int, ...] = eqx.field(static=True)

    def __call__(self, features: Array, start: Array, entries: tuple[Array | None, ...]) -> list[Array]:
        """The state after each joint.

        Args:
            features: shape (n_features,).
            start: state before joint 0, shape (rank,).
            entries: per joint, what is added to the state there, shape (rank,) or None.
        """
        states, state, one = [], start, jnp.ones_like(start, shape=1)
        first = np.searchsorted(self.owner, np.arange(len(self.transfers) + 1))
        for joint, (transfer, entry) in enumerate(zip(self.transfers, entries, strict=True)):
            # One outer product instead of a product a feature: half the operations to differentiate and to compile.
            own = jnp.concatenate([one, features[first[joint] : first[joint + 1]]])
            state = transfer @ jnp.outer(own, state).ravel()
            state = state if entry is None else state + entry
            states.append(state)
        return states


def make_chain_network(key: Array, owner: tuple[int, ...], n_joints: int, rank: int) -> ChainNetwork:
    """Draw transfers that keep the size of a state on average."""
    transfers = []
    for joint, subkey in enumerate(jax.random.split(key, n_joints)):
        parts = 1 + sum(j == joint for j in owner)
        size = 1.0 if parts == 1 else 0.7
        transfers.append(size * jax.random.normal(subkey, (rank, rank * parts)) / jnp.sqrt(rank))
    return ChainNetwork(tuple(transfers), owner)
