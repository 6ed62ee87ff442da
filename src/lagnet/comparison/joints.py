"""Which of several models has the smallest error on a joint, and which are not told from it: bootstrap over blocks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

DRAWS = 2000
LEVEL = (2.5, 97.5)  # percentiles of an interval
ALIKE = 1e-3  # of the best error: models that differ by less say the same of a joint


@dataclass(frozen=True, eq=False)
class JointComparison:
    """One joint.

    Args:
        joint: name.
        nmse: shape (models,), squared error over the scatter of what was measured.
        interval: shape (models, 2), 95 %.
        against_best: shape (models, 2), 95 % of a model's error less that of the best.
        best: index of the model with the smallest error.
        also: indices of models that are not told from it.
    """

    joint: str
    nmse: np.ndarray
    interval: np.ndarray
    against_best: np.ndarray
    best: int
    also: tuple[int, ...]

    @property
    def alike(self) -> bool:
        """Whether all models say the same of this joint."""
        return bool(np.max(np.abs(self.against_best)) <= ALIKE * self.nmse[self.best])


def bootstrap_weights(blocks: int, seed: int) -> np.ndarray:
    """How often each block is drawn, shape (`DRAWS`, blocks)."""
    draws = np.random.default_rng(seed).multinomial(blocks, np.full(blocks, 1.0 / blocks), size=DRAWS)
    return draws.astype(float)


def judge_joint(name: str, nmse: np.ndarray, draws: np.ndarray) -> JointComparison:
    """The best model and those that are not told from it; nmse (models,), draws (`DRAWS`, models)."""
    best = int(np.argmin(nmse))
    interval = np.percentile(draws, LEVEL, axis=0).T
    worse = np.percentile(draws - draws[:, [best]], LEVEL, axis=0).T
    also = tuple(int(m) for m in range(len(nmse)) if m != best and worse[m, 0] <= 0.0)
    return JointComparison(name, nmse, interval, worse, best, also)
