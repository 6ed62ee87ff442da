"""ε(q, v, a) ≈ r, the residual of the mechanics: trained in stages, used at a joint as far as held-out blocks gain.

The mechanics are fixed: ε is a plain regression on their residual, so that it cannot replace mechanics.
Source: Wu 2024.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import cast

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import optax
from jaxtyping import Array

from lagnet.diagnosis.problem.problem import Problem, Segment, spread_evenly
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.remainder import LearnedRemainder, features
from lagnet.recordings.sampling import spread_rows


@dataclass(frozen=True)
class RemainderSettings:
    """Size and training of ε.

    Args:
        members: networks of the ensemble.
        hidden: units of each of two hidden layers.
        steps: of the optimiser, over all samples at once.
        rate: of learning.
        decay: of weights.
        folds: contiguous blocks that are left out in turn.
        gain: least reduction of a joint's held-out squared error by ε, as a share, to be used there.
        most: training samples.
        anchors: samples that describe the extent of the motion that was learned from.
    """

    members: int = 3
    hidden: int = 16
    steps: int = 200
    rate: float = 5e-3
    decay: float = 3e-2
    folds: int = 4
    gain: float = 0.1
    most: int = 1000
    anchors: int = 400


def learn_remainder(
    problem: Problem, model: CorrectedModel, seed: int, settings: RemainderSettings | None = None
) -> LearnedRemainder | None:
    """ε of the fitted recordings; None where no joint's held-out blocks gain from it.

    Args:
        problem: the diagnosis' problem.
        model: the mechanics, fixed.
        seed: of the networks.
        settings: size and training.
    """
    settings = settings or RemainderSettings()
    x, y, valid = _samples(problem, model, spread_evenly(problem.fit, 30 * settings.most), settings.most)
    centre, spread = x.mean(axis=0), np.maximum(x.std(axis=0), 1e-9)
    x, size = (
        (x - centre) / spread,
        np.maximum(np.sqrt(np.sum(y**2 * valid, axis=0) / np.maximum(valid.sum(0), 1)), 1e-12),
    )
    target = y / size
    share = _shares(x, target, valid, seed, settings)
    moves = valid[:, share > 0.0].all(axis=1)  # at rest nothing was learned: dry friction may take any value there
    if not (share.any() and moves.any()):
        return None
    weights, biases = _train(x, target, valid, seed, settings)
    weights[-1], biases[-1] = weights[-1] * size, biases[-1] * size
    seen = x[moves]
    anchors = seen[spread_rows(len(seen), settings.anchors)]
    return LearnedRemainder(centre, spread, tuple(weights), tuple(biases), share, anchors, _reach(seen, anchors))


def _samples(
    problem: Problem, model: CorrectedModel, pieces: Sequence[Segment], most: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Features, residual torque and mask of valid samples of the fitted motion, in the order of time."""
    xs, ys, masks = [], [], []
    for p in pieces:
        mechanics = replace(model, recording=p.origin)  # with what acts in this recording alone
        residual = problem.reduce(p, p.tau - mechanics.torque_along(p.time, p.q, p.v, p.a))
        xs.append(features(p.q[p.keep], p.v[p.keep], p.a[p.keep]))
        ys.append(residual)
        masks.append(p.counts)
    every = max(1, sum(map(len, xs)) // most)
    x, y, valid = (np.concatenate(parts)[::every] for parts in (xs, ys, masks))
    return x, y, valid.astype(float)


def _shares(x: np.ndarray, y: np.ndarray, valid: np.ndarray, seed: int, settings: RemainderSettings) -> np.ndarray:
    """argmin_s |y − s ε|² on held-out blocks, shape (dof,); 0 where the gain is small or in half of the blocks only."""
    edges = np.linspace(0, len(x), settings.folds + 1).round().astype(int)
    product, power, before = np.zeros((3, settings.folds, y.shape[1]))
    for k in range(settings.folds):
        held_out = np.zeros(len(x), dtype=bool)
        held_out[edges[k] : edges[k + 1]] = True
        weights, biases = _train(x, y, valid * ~held_out[:, None], seed, settings)
        guess = _mean(weights, biases, x[held_out])
        product[k] = np.sum(guess * y[held_out] * valid[held_out], axis=0)
        power[k] = np.sum(guess**2 * valid[held_out], axis=0)
        before[k] = np.sum(y[held_out] ** 2 * valid[held_out], axis=0)
    share = np.clip(product.sum(0) / np.maximum(power.sum(0), 1e-300), 0.0, 1.0)
    gain = 2.0 * share * product - share**2 * power
    useful = (gain.sum(0) > settings.gain * before.sum(0)) & (np.sum(gain > 0, axis=0) > settings.folds / 2)
    return np.where(useful, share, 0.0)


def _mean(weights: list[np.ndarray], biases: list[np.ndarray], x: np.ndarray) -> np.ndarray:
    h = np.broadcast_to(x, (weights[0].shape[0], *x.shape))
    for layer, (weight, bias) in enumerate(zip(weights, biases, strict=True)):
        h = h @ weight + bias[:, None, :]
        h = h if layer == len(weights) - 1 else np.tanh(h)
    mean, disagreement = h.mean(axis=0), h.std(axis=0)
    return mean**3 / np.maximum(mean**2 + disagreement**2, 1e-300)


def _train(
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


def _reach(x: np.ndarray, anchors: np.ndarray) -> float:
    """99 % quantile of the distance of a training sample to its nearest anchor."""
    rows = x[:: max(1, len(x) // 1000)]
    distance = np.sum(rows**2, axis=1)[:, None] - 2.0 * rows @ anchors.T + np.sum(anchors**2, axis=1)
    return max(float(np.quantile(np.sqrt(np.maximum(distance.min(axis=1), 0.0)), 0.99)), 0.1 * np.sqrt(x.shape[1]))
