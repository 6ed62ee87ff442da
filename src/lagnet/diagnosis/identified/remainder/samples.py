"""What ε is learned from."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lagnet.models.corrected.remainder.learned import LearnedRemainder, RemainderPart
from lagnet.recordings.sampling import spread_rows


@dataclass(frozen=True, eq=False)
class RemainderSamples:
    """Samples of the fitted motion in the order of time.

    Args:
        q, v, a: shape (n, dof).
        left: shape (n, dof), residual [N m].
        counts: shape (n, dof), whether the joint moves.
        slow: shape (dof,), speed below which it may rest [rad/s].
    """

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    left: np.ndarray
    counts: np.ndarray
    slow: np.ndarray

    def power(self) -> np.ndarray:
        """Mean square of the residual where a joint moves, shape (dof,)."""
        return np.sum(self.left**2 * self.counts, axis=0) / np.maximum(self.counts.sum(axis=0), 1)

    def thinned(self, most: int) -> RemainderSamples:
        """At most so many of them, spread over the whole motion."""
        rows = spread_rows(len(self.q), most)
        return RemainderSamples(self.q[rows], self.v[rows], self.a[rows], self.left[rows], self.counts[rows], self.slow)

    def without(self, part: RemainderPart) -> RemainderSamples:
        """What a part of ε leaves."""
        return replace(self, left=self.left - LearnedRemainder((part,), self.slow).torque(self.q, self.v, self.a))
