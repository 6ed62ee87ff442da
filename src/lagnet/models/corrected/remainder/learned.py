"""The learned remainder ε: torque that mechanics and named physics leave, as a sum of parts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from lagnet.types import JointVector, Trajectory

TOGETHER = 4096  # samples that are looked at together: more would fill the memory with what each part holds of them


@runtime_checkable
class RemainderPart(Protocol):
    """A part of ε."""

    @property
    def share(self) -> JointVector:
        """Share of this part that is used at each joint, shape (dof,); 0 where unseen samples did not gain."""
        ...

    def torque(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """Torque of a few thousand samples that stand for themselves, shape (n, dof) [N m]."""
        ...


@dataclass(frozen=True, eq=False)
class LearnedRemainder:
    """ε(q, v, a) = Σ_k ε_k(q, v, a).

    Args:
        parts: in the order of their training, each on what those before it left.
        slow: shape (dof,), speed below which a joint may rest, where dry friction takes any value: ε fades with |v|
            there [rad/s].
    """

    parts: tuple[RemainderPart, ...]
    slow: JointVector

    @property
    def acts_on(self) -> np.ndarray:
        """Joints at which some part is used, shape (dof,)."""
        return np.any([part.share > 0.0 for part in self.parts], axis=0)

    def torque(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """ε at samples that stand for themselves, shape (n, dof) [N m]."""
        out = np.zeros(np.shape(q))
        for start in range(0, len(q), TOGETHER):
            rows = slice(start, start + TOGETHER)
            for part in self.parts:
                out[rows] += part.torque(q[rows], v[rows], a[rows])
        return out * np.minimum(1.0, np.abs(v) / self.slow)


def angles(q: Trajectory) -> np.ndarray:
    """Sine and cosine of positions, shape (n, 2 dof): a turn more of a joint is no other place."""
    return np.hstack([np.sin(q), np.cos(q)])


def squared_distances(x: np.ndarray, anchors: np.ndarray) -> np.ndarray:
    """|x_i − y_k|², shape (n, m), without negative rounding."""
    squares = np.sum(x**2, axis=1)[:, None] - 2.0 * x @ anchors.T + np.sum(anchors**2, axis=1)
    return np.maximum(squares, 0.0)
