"""Training of ε in JAX: small networks of all joints and members, all samples at once.

Apart from what uses it: where nothing is left to learn, JAX is not even imported.
"""

from __future__ import annotations

from itertools import pairwise
from typing import cast

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import optax
from jaxtyping import Array

from lagnet.diagnosis.identified.remainder.settings import RemainderSettings
from lagnet.models.corrected.remainder.network import outputs


def trained_networks(
    x: np.ndarray, y: np.ndarray, counts: np.ndarray, seed: int, settings: RemainderSettings
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Weights (members, dof, n_in, n_out) and biases (members, dof, n_out) of each layer.

    Args:
        x: shape (dof, n, n_inputs), standardised.
        y: shape (n, dof).
        counts: shape (members, n, dof), weight of each sample for each member.
        seed: of the weights before training.
        settings: size and training.
    """
    n_dof, members, sizes = len(x), len(counts), (x.shape[2], settings.hidden, settings.hidden, 1)
    generator = np.random.default_rng(seed)
    weights = [
        jnp.asarray(generator.normal(0.0, 1.0 / np.sqrt(n), (members, n_dof, n, m)), jnp.float32)
        for n, m in pairwise(sizes)
    ]
    weights[-1] = np.float32(0.1) * weights[-1]
    biases = [jnp.zeros((members, n_dof, m), jnp.float32) for m in sizes[1:]]
    share = counts / np.maximum(counts.sum(axis=1, keepdims=True), 1.0)
    x32, y32, share32 = (jnp.asarray(z, jnp.float32) for z in (x, y.T, share.transpose(0, 2, 1)))
    trained = _descend((weights, biases), x32, y32, share32, settings)
    return [np.asarray(w, dtype=float) for w in trained[0]], [np.asarray(b, dtype=float) for b in trained[1]]


@eqx.filter_jit
def _descend(
    start: tuple[list[Array], list[Array]], x: Array, y: Array, share: Array, settings: RemainderSettings
) -> tuple[list[Array], list[Array]]:
    optimiser = optax.adamw(optax.cosine_decay_schedule(settings.rate, settings.steps), weight_decay=settings.decay)

    def loss(net: tuple[list[Array], list[Array]]) -> Array:
        return jnp.sum((outputs(*net, x, jnp.tanh) - y) ** 2 * share)

    def step(carry, _):
        net, state = carry
        updates, state = optimiser.update(jax.grad(loss)(net), state, net)
        return (optax.apply_updates(net, updates), state), None

    (net, _), _ = jax.lax.scan(step, (start, optimiser.init(start)), None, length=settings.steps)
    return cast(tuple[list[Array], list[Array]], net)
