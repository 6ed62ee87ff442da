"""ε(q, v, a) ≈ r, the residual of the mechanics: trained in stages, used at a joint as far as held-out blocks gain.

The mechanics are fixed: ε is a plain regression on their residual, so that it cannot replace mechanics.
Source: Wu 2024.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.identified.remainder_settings import RemainderSettings
from lagnet.diagnosis.problem.problem import Problem, Segment, spread_evenly
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.remainder import LearnedRemainder, features
from lagnet.recordings.sampling import spread_rows


def learn_remainder(
    problem: Problem,
    model: CorrectedModel,
    seed: int,
    settings: RemainderSettings | None = None,
    floor: np.ndarray | float = 0.0,
) -> LearnedRemainder | None:
    """ε of the fitted recordings; None where no joint's held-out blocks gain from it.

    Args:
        problem: the diagnosis' problem.
        model: the mechanics, fixed.
        seed: of the networks.
        settings: size and training.
        floor: shape (dof,), residual up to which nothing is left to learn at a joint [N m].
    """
    settings = settings or RemainderSettings()
    x, y, valid = _samples(problem, model, spread_evenly(problem.fit, 30 * settings.most), settings.most)
    power = np.sum(y**2 * valid, axis=0) / np.maximum(valid.sum(axis=0), 1)
    if np.all(power <= np.square(floor)):
        return None
    centre, spread = x.mean(axis=0), np.maximum(x.std(axis=0), 1e-9)
    x, size = (x - centre) / spread, np.maximum(np.sqrt(power), 1e-12)
    target = y / size
    share = _shares(x, target, valid, seed, settings)
    moves = valid[:, share > 0.0].all(axis=1)  # at rest nothing was learned: dry friction may take any value there
    if not (share.any() and moves.any()):
        return None
    weights, biases = _trained(x, target, valid, seed, settings)
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
        weights, biases = _trained(x, y, valid * ~held_out[:, None], seed, settings)
        guess = _mean(weights, biases, x[held_out])
        product[k] = np.sum(guess * y[held_out] * valid[held_out], axis=0)
        power[k] = np.sum(guess**2 * valid[held_out], axis=0)
        before[k] = np.sum(y[held_out] ** 2 * valid[held_out], axis=0)
    share = np.clip(product.sum(0) / np.maximum(power.sum(0), 1e-300), 0.0, 1.0)
    gain = 2.0 * share * product - share**2 * power
    useful = (gain.sum(0) > settings.gain * before.sum(0)) & (np.sum(gain > 0, axis=0) > settings.folds / 2)
    return np.where(useful, share, 0.0)


def _trained(
    x: np.ndarray, y: np.ndarray, valid: np.ndarray, seed: int, settings: RemainderSettings
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    from lagnet.diagnosis.identified.remainder_training import trained_networks  # JAX: a fourth of all imports

    return trained_networks(x, y, valid, seed, settings)


def _mean(weights: list[np.ndarray], biases: list[np.ndarray], x: np.ndarray) -> np.ndarray:
    h = np.broadcast_to(x, (weights[0].shape[0], *x.shape))
    for layer, (weight, bias) in enumerate(zip(weights, biases, strict=True)):
        h = h @ weight + bias[:, None, :]
        h = h if layer == len(weights) - 1 else np.tanh(h)
    mean, disagreement = h.mean(axis=0), h.std(axis=0)
    return mean**3 / np.maximum(mean**2 + disagreement**2, 1e-300)


def _reach(x: np.ndarray, anchors: np.ndarray) -> float:
    """99 % quantile of the distance of a training sample to its nearest anchor."""
    rows = x[:: max(1, len(x) // 1000)]
    distance = np.sum(rows**2, axis=1)[:, None] - 2.0 * rows @ anchors.T + np.sum(anchors**2, axis=1)
    return max(float(np.quantile(np.sqrt(np.maximum(distance.min(axis=1), 0.0)), 0.99)), 0.1 * np.sqrt(x.shape[1]))
