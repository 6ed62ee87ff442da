"""Robots of one make share a prior: a level of each is drawn towards those of its sisters, and an odd one stands out.

    θ_r ~ N(μ, τ²),   θ̂_r ~ N(θ_r, s_r²)

μ and τ come from the sisters alone (each robot is judged without itself), τ by Paule and Mandel's moments; robots that
stand out are then left out of μ and τ of all others, until no more do. Source: efron1973, paule1982.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import false_discovery_control
from scipy.stats import t as student

from lagnet.tracking.statistics.covariates import root

SISTERS = 4  # from which a family can be spoken of
ROUNDS = 10


@dataclass(frozen=True, eq=False)
class Family:
    """Levels of one parameter over the robots of a make, shapes (n_robots,).

    Args:
        mean, spread: μ and τ of the robots that do not stand out.
        pooled: each level drawn towards the mean by its uncertainty.
        p_value: that a robot of the family lies as far from its sisters; 1 where there are too few of them.
    """

    mean: float
    spread: float
    pooled: np.ndarray
    p_value: np.ndarray


def pool(level: np.ndarray, sigma: np.ndarray, rate: float) -> Family:
    """The family of a make.

    Args:
        level, sigma: shape (n,), levels and their standard deviations.
        rate: of false discoveries, at which a robot stands out while the family is estimated.
    """
    inside = np.ones(level.size, dtype=bool)
    p = np.ones(level.size)
    for _ in range(ROUNDS):
        p = np.array([_p_value(level, sigma, inside, r) for r in range(level.size)])
        kept = false_discovery_control(p) > rate if level.size else inside
        if 2 * kept.sum() <= level.size or np.array_equal(kept, inside):
            break
        inside = kept
    mean, spread, _ = _moments(level[inside], sigma[inside])
    weight = spread**2 / np.maximum(spread**2 + sigma**2, 1e-300)
    return Family(mean, spread, mean + weight * (level - mean), p)


def _p_value(level: np.ndarray, sigma: np.ndarray, inside: np.ndarray, robot: int) -> float:
    sisters = inside.copy()
    sisters[robot] = False
    if sisters.sum() < SISTERS:
        return 1.0
    mean, spread, variance = _moments(level[sisters], sigma[sisters])
    score = (level[robot] - mean) / np.sqrt(spread**2 + sigma[robot] ** 2 + variance)
    return float(2.0 * student.sf(abs(score), sisters.sum() - 1))


def _moments(level: np.ndarray, sigma: np.ndarray) -> tuple[float, float, float]:
    """μ, τ and the variance of μ."""

    def weighted(spread2: float) -> tuple[float, float, np.ndarray]:
        weight = 1.0 / np.maximum(sigma**2 + spread2, 1e-300)
        mean = float(np.sum(weight * level) / weight.sum())
        return mean, float(np.sum(weight * (level - mean) ** 2)) - (level.size - 1), weight

    if level.size == 0:
        return 0.0, 0.0, 0.0
    top = float(np.var(level) * level.size + 1e-12)
    spread2 = 0.0
    if weighted(0.0)[1] > 0.0:
        spread2 = root(lambda s: weighted(s)[1], 0.0, top) if weighted(top)[1] < 0 else top
    mean, _, weight = weighted(spread2)
    return mean, float(np.sqrt(spread2)), float(1.0 / weight.sum())
