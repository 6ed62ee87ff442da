"""Training of ε in JAX: an ensemble of small networks, all samples at once.

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

from lagnet.diagnosis.identified.remainder_settings import RemainderSettings


def trained_networks(
    x: np.ndarray, y: np.ndarray, valid: np.ndarray, seed: int, settings: RemainderSettings
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Weights and biases of all members, each of shape (members, ...)."""
    sizes = (x.shape[1], settings.hidden, settings.hidden, y.shape[1])
    generator = np.random.default_rng(seed)
    weights = [
        jnp.asarray(generator.normal(0.0, 1.0 / np.sqrt(n), (settings.members, n, m)), jnp.float32)
        for n, m in pairwise(sizes)
    ]
    weights[-1] = np.float32(0.1) * weights[-1]
    biases = [jnp.zeros((settings.members, m), jnp.float32) for m in sizes[1:]]
    x32, y32, valid32 = (jnp.asarray(z, jnp.float32) for z in (x, y, valid))
    trained = _descend((weights, biases), x32, y32, valid32, settings)
    return [np.asarray(w, dtype=float) for w in trained[0]], [np.asarray(b, dtype=float) for b in trained[1]]


@eqx.filter_jit
def _descend(
    start: tuple[list[Array], list[Array]], x: Array, y: Array, valid: Array, settings: RemainderSettings
) -> tuple[list[Array], list[Array]]:
    optimiser = optax.adamw(optax.cosine_decay_schedule(settings.rate, settings.steps), weight_decay=settings.decay)

    def loss(net: tuple[list[Array], list[Array]]) -> Array:
        h = jnp.broadcast_to(x, (net[0][0].shape[0], *x.shape))
        for layer, (weight, bias) in enumerate(zip(*net, strict=True)):
            h = h @ weight + bias[:, None, :]
            h = h if layer == len(net[0]) - 1 else jnp.tanh(h)
        return jnp.sum((h - y[None]) ** 2 * valid[None]) / jnp.sum(valid) / h.shape[0] * h.shape[2]

    def step(carry, _):
        net, state = carry
        updates, state = optimiser.update(jax.grad(loss)(net), state, net)
        return (optax.apply_updates(net, updates), state), None

    (net, _), _ = jax.lax.scan(step, (start, optimiser.init(start)), None, length=settings.steps)
    return cast(tuple[list[Array], list[Array]], net)
