"""ε of networks: each member of a committee leaves one block of the motion out, which tells what the others are worth.

A committee of the networks of a cross-validation is at once the ensemble and its test (Krogh and Vedelsby 1995).
"""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.identified.remainder.samples import RemainderSamples
from lagnet.diagnosis.identified.remainder.settings import RemainderSettings
from lagnet.models.corrected.remainder.learned import squared_distances
from lagnet.models.corrected.remainder.network import NetworkRemainder, network_inputs, outputs
from lagnet.recordings.sampling import spread_rows


def fit_networks(samples: RemainderSamples, seed: int, settings: RemainderSettings) -> NetworkRemainder | None:
    """ε of networks; None where no joint's held-out blocks gain."""
    from lagnet.diagnosis.identified.remainder.training import trained_networks  # JAX: a fourth of all imports

    x = network_inputs(samples.q, samples.v, samples.a, samples.slow)
    centre, spread = x.mean(axis=1), np.maximum(x.std(axis=1), 1e-9)
    x = (x - centre[:, None]) / spread[:, None]
    size = np.maximum(np.sqrt(samples.power()), 1e-12)
    target, counts = samples.left / size, samples.counts.astype(float)
    blocks = np.array_split(np.arange(len(target)), settings.members)
    weights, biases = trained_networks(x, target, _without_one(counts, blocks), seed, settings)
    share = _share(outputs(weights, biases, x), target, counts, blocks, settings.gain)
    if not share.any():
        return None
    weights[-1], biases[-1] = weights[-1] * size[:, None, None], biases[-1] * size[:, None]
    extent = _extent(x, samples.counts, settings.anchors)
    return NetworkRemainder(centre, spread, tuple(weights), tuple(biases), share, *extent, samples.slow)


def _without_one(counts: np.ndarray, blocks: list[np.ndarray]) -> np.ndarray:
    """Weight of each sample for each member, shape (members, n, dof)."""
    out = np.repeat(counts[None], len(blocks), axis=0)
    for member, block in enumerate(blocks):
        out[member, block] = 0.0
    return out


def _share(
    told: np.ndarray, target: np.ndarray, counts: np.ndarray, blocks: list[np.ndarray], least: float
) -> np.ndarray:
    """argmin_s |y − s ε|² on held-out blocks, shape (dof,); 0 where the gain is small or in half of the blocks only.

    Args:
        told: shape (members, dof, n), torque of each member, of which the k-th has not seen the k-th block.
    """
    unseen = np.concatenate([told[k][:, block].T for k, block in enumerate(blocks)])
    product, power = unseen * target * counts, unseen**2 * counts
    share = np.clip(product.sum(axis=0) / np.maximum(power.sum(axis=0), 1e-300), 0.0, 1.0)
    gain = np.array([np.sum((2.0 * share * product - share**2 * power)[block], axis=0) for block in blocks])
    enough = gain.sum(axis=0) > least * np.sum(target**2 * counts, axis=0)
    return np.where(enough & (np.sum(gain > 0.0, axis=0) > len(blocks) / 2), share, 0.0)


def _extent(x: np.ndarray, counts: np.ndarray, most: int) -> tuple[np.ndarray, np.ndarray]:
    """Anchors (dof, most, n_inputs) of each joint's motion, and its reach (dof,).

    The reach is the 99 % quantile of a training sample's distance to its nearest anchor.
    """
    anchors, reach = [], []
    for joint, moves in enumerate(counts.T):
        seen = x[joint][moves] if moves.any() else x[joint]
        chosen = seen[np.linspace(0, len(seen) - 1, most).round().astype(int)]
        nearest = np.sqrt(squared_distances(seen[spread_rows(len(seen), 1000)], chosen).min(axis=1))
        anchors.append(chosen)
        reach.append(max(float(np.quantile(nearest, 0.99)), 0.1 * np.sqrt(x.shape[2])))
    return np.array(anchors), np.array(reach)
