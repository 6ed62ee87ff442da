"""ε of networks: for each joint a committee of small ones over its own motion and the positions of the arm."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.models.corrected.remainder.learned import angles, squared_distances
from lagnet.types import JointVector, Trajectory

BEYOND = 1.5  # times the distance of the farthest training sample at which a network is silent
OWN = 3  # inputs of a joint beside the positions: speed, acceleration, smooth sign


@dataclass(frozen=True, eq=False)
class NetworkRemainder:
    """ε_j(sin q, cos q, v_j, a_j, tanh(v_j/slow_j)) of every joint j: what generalises to other motions.

    Friction, ripple and cables hang on these; speeds of the other joints would be as many ways to learn by heart.

    Args:
        centre, spread: shape (dof, n_inputs), by which inputs are standardised.
        weights: one array (members, dof, n_in, n_out) a layer; tanh between layers.
        biases: one array (members, dof, n_out) a layer; the last has one output, the torque [N m].
        share: shape (dof,), of the committee's mean that is used at each joint.
        anchors: shape (dof, n_anchors, n_inputs), standardised samples at which the joint moved in training.
        reach: shape (dof,), distance to the nearest anchor up to which a network is used in full.
        slow: shape (dof,), width of the smooth sign [rad/s].
    """

    centre: np.ndarray
    spread: np.ndarray
    weights: tuple[np.ndarray, ...]
    biases: tuple[np.ndarray, ...]
    share: JointVector
    anchors: np.ndarray
    reach: JointVector
    slow: JointVector

    def torque(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """ε at samples that stand for themselves, shape (n, dof) [N m]."""
        out = np.zeros(np.shape(q))
        used = np.flatnonzero(self.share)
        x = (network_inputs(q, v, a, self.slow)[used] - self.centre[used, None]) / self.spread[used, None]
        h = outputs([w[:, used] for w in self.weights], [b[:, used] for b in self.biases], x)
        out[:, used] = (believed(h) * self.share[used, None]).T
        out[:, used] *= self._known(x, used).T
        return out

    def _known(self, x: np.ndarray, joints: np.ndarray) -> np.ndarray:
        """One near the training motion, falling to zero at BEYOND times its reach, shape (joints, n)."""
        squares = [
            squared_distances(one, anchors).min(axis=1) for one, anchors in zip(x, self.anchors[joints], strict=True)
        ]
        return np.clip((BEYOND - np.sqrt(squares) / self.reach[joints, None]) / (BEYOND - 1.0), 0.0, 1.0)


def network_inputs(q: Trajectory, v: Trajectory, a: Trajectory, slow: JointVector) -> np.ndarray:
    """What the networks of each joint see, shape (dof, n, 2 dof + 3)."""
    own = np.stack([v, a, np.tanh(v / slow)], axis=2).transpose(1, 0, 2)
    everywhere = np.broadcast_to(angles(q), (own.shape[0], len(q), 2 * own.shape[0]))
    return np.concatenate([everywhere, own], axis=2)


def outputs(weights: Sequence[Any], biases: Sequence[Any], x: Any, tanh: Callable[[Any], Any] = np.tanh) -> Any:
    """Torque of each member, shape (members, dof, n), at standardised inputs x of shape (dof, n, n_inputs).

    Args:
        weights, biases: of each layer, see `NetworkRemainder`; arrays of NumPy or, in training, of JAX.
        x: of the same library.
        tanh: of the same library.
    """
    h = x
    for layer, (weight, bias) in enumerate(zip(weights, biases, strict=True)):
        h = h @ weight + bias[:, :, None, :]
        h = h if layer == len(weights) - 1 else tanh(h)
    return h[..., 0]


def believed(h: np.ndarray) -> np.ndarray:
    """Mean of the members, shape (dof, n), less where they disagree: they know nothing there."""
    mean, disagreement = h.mean(axis=0), h.std(axis=0)
    return mean**3 / np.maximum(mean**2 + disagreement**2, 1e-300)
