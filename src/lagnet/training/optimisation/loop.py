"""The training loop: chunks of steps compiled as one scan, with data, shuffling and optimiser on the device."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import optax
from jaxtyping import Array

from lagnet.models.dynamics import AbstractDynamics
from lagnet.models.networks import OrderedNetwork
from lagnet.training.cores import everywhere, mesh_for, on_one_device, spread
from lagnet.training.optimisation.loss import Errors, errors, penalised
from lagnet.training.optimisation.soap import scale_by_soap
from lagnet.training.settings import TrainingSettings

CHUNK = 100  # steps compiled together; between chunks come reports, checkpoints and stopping
LAST_SHARE = 1e-4  # learning rate at the end of the cosine, as a share of its peak
JUDGED = 2048  # samples of either side on which errors are reported


class LoopState(NamedTuple):
    """All that the loop carries, and all that a checkpoint must hold."""

    params: Any
    optimiser: Any
    key: Array
    step: Array


class Loop(NamedTuple):
    """Compiled functions of one training.

    Args:
        start: state at step 0.
        advance: (state, data, λ, total steps) → (state after CHUNK steps, mean loss).
        judge: (params, data) → Errors.
        assemble: params → model.
        place: data → data where `advance` works on it.
    """

    start: LoopState
    advance: Callable[..., tuple[LoopState, Array]]
    judge: Callable[..., Errors]
    assemble: Callable[[Any], AbstractDynamics]
    place: Callable[[Any], Any]


def make_loop(
    dynamics: AbstractDynamics, variance: Array, n_samples: int, settings: TrainingSettings, seed: int, trainable: Any
) -> Loop:
    """Prepare a training.

    Args:
        dynamics: the model to start from.
        variance: torque variance of each joint, shape (dof,).
        n_samples: rows of the training data.
        settings: how to train.
        seed: of the shuffling.
        trainable: filter that is true for the leaves to be trained; the others keep their values.
    """
    params, fixed = eqx.partition(dynamics, trainable)
    direction = _direction(settings.optimiser)
    batch = min(settings.batch, n_samples)
    mesh = mesh_for(batch)

    def loss(params: Any, data: tuple[Array, ...], rows: Array, penalty: Array) -> Array:
        return penalised(errors(eqx.combine(params, fixed), tuple(x[rows] for x in data), variance), penalty)

    gradient = spread(jax.value_and_grad(loss), mesh)

    def advance(state: LoopState, data: tuple[Array, ...], penalty: Array, total: Array) -> tuple[LoopState, Array]:
        key, subkey = jax.random.split(state.key)

        def step(carry: tuple[Any, Any, Array], rows: Array) -> tuple[tuple[Any, Any, Array], Array]:
            params, memory, count = carry
            value, grads = gradient(params, data, rows, penalty)
            updates, memory = direction.update(grads, memory, params)
            rate = _rate(count, total, settings)
            params = jax.tree.map(lambda p, u: p - rate * u, _shrunk(params, rate * settings.weight_decay), updates)
            return (params, memory, count + 1), value

        carry = (state.params, state.optimiser, state.step)
        (params, memory, count), values = jax.lax.scan(step, carry, _shuffled(subkey, n_samples, batch))
        return LoopState(params, memory, key, count), jnp.mean(values)

    start = LoopState(params, direction.init(params), jax.random.key(seed), jnp.zeros((), jnp.int32))
    judge = jax.jit(lambda params, data: errors(eqx.combine(params, fixed), data, variance))
    place = partial(everywhere, mesh=mesh)
    return Loop(start, jax.jit(advance), judge, lambda params: eqx.combine(on_one_device(params), fixed), place)


def _shuffled(key: Array, n_samples: int, batch: int) -> Array:
    """Rows of each minibatch of a chunk, shape (CHUNK, batch): each sample once before any comes twice."""
    rounds = -(-CHUNK * batch // n_samples)
    orders = jax.vmap(lambda k: jax.random.permutation(k, n_samples))(jax.random.split(key, rounds))
    return orders.reshape(-1)[: CHUNK * batch].reshape(CHUNK, batch)


def _rate(count: Array, total: Array, settings: TrainingSettings) -> Array:
    """Learning rate: a linear rise, then half a cosine."""
    rise = jnp.minimum(1.0, (count + 1) / settings.warm_up)
    fall = 0.5 * (1.0 + jnp.cos(jnp.pi * jnp.minimum(1.0, count / total)))
    return settings.peak * rise * (LAST_SHARE + (1.0 - LAST_SHARE) * fall)


def _shrunk(params: Any, share: Array) -> Any:
    """Weights of perceptrons less a share of them; all else, whose sizes mean something, as it is."""

    def smaller(part: Any) -> Any:
        if not isinstance(part, OrderedNetwork):
            return part
        return eqx.tree_at(lambda x: x.weights, part, jax.tree.map(lambda w: (1.0 - share) * w, part.weights))

    return jax.tree.map(smaller, params, is_leaf=lambda x: isinstance(x, OrderedNetwork))


def _direction(name: str) -> optax.GradientTransformation:
    if name == "muon":
        return optax.contrib.muon(learning_rate=-1.0)
    return scale_by_soap() if name == "soap" else optax.scale_by_adam()
