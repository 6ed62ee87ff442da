"""The learned remainder ε: an ensemble of small networks on top of fixed mechanics, silent beyond its training."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.types import Trajectory

BEYOND = 1.5  # times the distance of the farthest training sample at which ε is silent


@dataclass(frozen=True, eq=False)
class LearnedRemainder:
    """Torque that mechanics and named physics leave, as a function of the sample: ε(q, v, a).

    Args:
        centre, spread: shape (n_inputs,), by which features are standardised.
        weights: one array (members, n_in, n_out) a layer; tanh between layers.
        biases: one array (members, n_out) a layer.
        share: shape (dof,), of the ensemble's mean that is used at each joint; 0 where unseen blocks did not gain.
        anchors: shape (n_anchors, n_inputs), standardised samples of the training motion.
        reach: distance to the nearest anchor up to which ε is used in full.
    """

    centre: np.ndarray
    spread: np.ndarray
    weights: tuple[np.ndarray, ...]
    biases: tuple[np.ndarray, ...]
    share: np.ndarray
    anchors: np.ndarray
    reach: float

    def torque(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """ε at samples that stand for themselves, shape (n, dof) [N m]."""
        x = (features(q, v, a) - self.centre) / self.spread
        h = np.broadcast_to(x, (self.weights[0].shape[0], *x.shape))
        for layer, (weight, bias) in enumerate(zip(self.weights, self.biases, strict=True)):
            h = h @ weight + bias[:, None, :]
            h = h if layer == len(self.weights) - 1 else np.tanh(h)
        mean, disagreement = h.mean(axis=0), h.std(axis=0)
        sure = mean**2 / np.maximum(mean**2 + disagreement**2, 1e-300)  # members that disagree know nothing
        return mean * sure * self.share * self._known(x)[:, None]

    def _known(self, x: np.ndarray) -> np.ndarray:
        """One near the training motion, falling to zero at BEYOND times its reach, shape (n,)."""
        squares = np.sum(self.anchors**2, axis=1)
        out = np.empty(len(x))
        for start in range(0, len(x), 4096):
            part = x[start : start + 4096]
            distance = np.sum(part**2, axis=1)[:, None] - 2.0 * part @ self.anchors.T + squares
            out[start : start + 4096] = np.sqrt(np.maximum(distance.min(axis=1), 0.0))
        return np.clip((BEYOND - out / self.reach) / (BEYOND - 1.0), 0.0, 1.0)


def features(q: Trajectory, v: Trajectory, a: Trajectory) -> np.ndarray:
    """What ε sees: sine and cosine of positions, speeds and accelerations, shape (n, 4 dof)."""
    return np.hstack([np.sin(q), np.cos(q), v, a])
