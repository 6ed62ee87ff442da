"""Training of ε in JAX: small networks of all joints and members, all samples at once.

Apart from what uses it: where nothing is left to learn, JAX is not even imported.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any, cast

import jax
import jax.numpy as jnp
import numpy as np
import optax
from jax import Array
from jax.flatten_util import ravel_pytree

from lagnet.diagnosis.identified.remainder.settings import RemainderSettings
from lagnet.models.corrected.remainder.network import outputs

COMPILER = {"xla_backend_optimization_level": 1}  # compiling takes longer than training: a third less, and no slower

Network = tuple[list[Any], list[Any]]  # weights and biases of each layer


def trained_networks(
    x: np.ndarray, y: np.ndarray, counts: np.ndarray, seed: int, settings: RemainderSettings
) -> Network:
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
    weights = [generator.normal(0.0, 1.0 / np.sqrt(n), (members, n_dof, n, m)) for n, m in pairwise(sizes)]
    weights[-1] *= 0.1
    start = weights, [np.zeros((members, n_dof, m)) for m in sizes[1:]]
    share = counts / np.maximum(counts.sum(axis=1, keepdims=True), 1.0)
    single = jax.tree.map(np.float32, (start, x, y.T, share.transpose(0, 2, 1)))
    training = jax.jit(_descend, static_argnames="settings", compiler_options=COMPILER)
    return cast(Network, jax.tree.map(lambda part: np.asarray(part, dtype=float), training(*single, settings)))


def _descend(start: Network, x: Array, y: Array, share: Array, settings: RemainderSettings) -> Network:
    optimiser = optax.adamw(optax.cosine_decay_schedule(settings.rate, settings.steps), weight_decay=settings.decay)
    flat, network = ravel_pytree(start)  # one vector: one update to compile in the place of six

    def loss(parameters: Array) -> Array:
        weights, biases = network(parameters)
        return jnp.sum((outputs(weights, biases, x, jnp.tanh) - y) ** 2 * share)

    def step(carry, _):
        parameters, state = carry
        updates, state = optimiser.update(jax.grad(loss)(parameters), state, parameters)
        return (cast(Array, optax.apply_updates(parameters, updates)), state), None

    (parameters, _), _ = jax.lax.scan(step, (flat, optimiser.init(flat)), None, length=settings.steps)
    return network(parameters)
