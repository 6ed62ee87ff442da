"""Cov = H⁻¹ S H⁻¹ of values fitted to rollouts of the whole arm, and half-widths of 95 % intervals.

As in `motion.intervals`: S is the covariance of the scores over blocks of time, whose errors are correlated within, and
half an encoder step that errs to one side is added. Source: White 1982.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lagnet.diagnosis.motion.joint.fitting import HUBER, robust_scale
from lagnet.diagnosis.motion.joint.intervals import NORMAL_95

BLOCKS = 40  # of time
UNSEEN = 1e-6  # of the largest eigenvalue of the normal matrix: a direction that no joint shows


def half_widths(
    errors: Sequence[np.ndarray], jacobians: Sequence[np.ndarray], floors: np.ndarray, to_values: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Half-widths of `to_values` times the coordinates, shape (m,), and the directions not seen, shape (k, unseen).

    Args:
        errors: of each joint at the fitted values, each of shape (n,) [rad].
        jacobians: ∂q̂/∂x of each joint, each of shape (n, k).
        floors: shape (joints,), resolution of the errors [rad].
        to_values: shape (m, k).
    """
    count = to_values.shape[1]
    weighted, normal = _weighted(errors, jacobians, floors)
    parts = [np.array_split(w * e[:, None], BLOCKS) for w, e in zip(weighted, errors, strict=True)]
    scores = sum((np.array([b.sum(axis=0) for b in p]) for p in parts), np.zeros((BLOCKS, count)))
    inverse, unseen = _inverse(normal)
    spread = to_values @ inverse
    centred = scores - scores.mean(axis=0)
    variance = np.diag(spread @ (centred.T @ centred) @ spread.T) * BLOCKS / max(1.0, BLOCKS - count)
    half = NORMAL_95 * np.sqrt(np.maximum(variance, 0.0))
    systematic = zip(weighted, 0.5 * np.asarray(floors), strict=True)
    half = half + sum(np.abs(w @ spread.T).sum(axis=0) * step for w, step in systematic)
    return half, unseen


def ridges(errors: Sequence[np.ndarray], jacobians: Sequence[np.ndarray], floors: np.ndarray) -> np.ndarray:
    """Along row i all coordinates go as they do in the best fit of each value of coordinate i, shape (k, k).

    Coordinate i itself goes by 1 along its row; by 0 where no joint shows it. Arguments as those of `half_widths`.
    """
    inverse, _ = _inverse(_weighted(errors, jacobians, floors)[1])
    own = np.diag(inverse)
    return np.where(own[:, None] > 0.0, inverse / np.where(own > 0.0, own, 1.0)[:, None], 0.0)


def _weighted(
    errors: Sequence[np.ndarray], jacobians: Sequence[np.ndarray], floors: np.ndarray
) -> tuple[list[np.ndarray], np.ndarray]:
    """W J of every joint, with Huber's weights over squared robust scales, and the normal matrix Σ Jᵀ W J."""
    weighted = []
    for e, jacobian, floor in zip(errors, jacobians, floors, strict=True):
        scale = robust_scale(e, floor)
        weighted.append(jacobian * (1.0 / np.maximum(1.0, np.abs(e) / (HUBER * scale)) / scale**2)[:, None])
    return weighted, sum((w.T @ j for w, j in zip(weighted, jacobians, strict=True)), np.zeros((1, 1)))


def _inverse(normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The inverse of a normal matrix over the directions that a joint shows, and those that none does (k, unseen)."""
    power, vectors = np.linalg.eigh(normal)
    seen = power > UNSEEN * power[-1]
    return (vectors[:, seen] / power[seen]) @ vectors[:, seen].T, vectors[:, ~seen]


def widening(
    errors: Sequence[np.ndarray], jacobians: Sequence[np.ndarray], floors: np.ndarray, columns: Sequence[int]
) -> float:
    """Largest factor by which the interval of a coordinate is wider than if those of `columns` were known.

    Two coordinates that motion tells apart leave each other's intervals as they are; of a pair whose errors are
    correlated by ρ each is 1/√(1 − ρ²) times as wide.

    Returns:
        Infinity where `columns` add a direction that no joint shows; 1 where there is no other coordinate.
    """
    count = jacobians[0].shape[1]
    others = np.setdiff1d(np.arange(count), columns)
    if not others.size:
        return 1.0
    with_all, unseen = half_widths(errors, jacobians, floors, np.eye(count)[others])
    alone, blind = half_widths(errors, [j[:, others] for j in jacobians], floors, np.eye(others.size))
    if unseen.shape[1] > blind.shape[1]:
        return np.inf
    known = (alone > 0.0) & (np.sum(blind**2, axis=1) < 0.5)  # others have no interval that could be wider
    return float(np.max(with_all[known] / alone[known], initial=1.0))
