"""The least that any load leaves of a recording: Σ r² − n over Σ r₀² − n, its ten parameters free and all else scaled.

A load is fitted with its edges beside what lasts, and twice where the usual residual is none of noise: that takes a
third of a diagnosis. Where not even ten free numbers explain much, no body does.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.diagnosis.regression.normal_equations import left_beside
from lagnet.effects.inertia.payload import Payload
from lagnet.models.corrected.named_effects import NamedEffect, torque_with

POOR = 0.5  # of a recording's residual power above noise; a load that has a name leaves a quarter at most


def may_have_load(
    problem: Problem, recordings: Sequence[int | None], persistent: Sequence[NamedEffect], power: np.ndarray
) -> bool:
    """Whether a load could explain half of what is left of one of some fitted recordings.

    Joints are weighted by the usual power, and by what is left of them on the mean where that is less.

    Args:
        persistent: effects that act always.
        power: shape (dof,), usual r² [N² m²].
    """
    parts = [_columns(problem, p, persistent) for p in problem.fit]
    wanted, valid = (np.concatenate([x[k] for x in parts]) for k in (0, 2))
    mean = np.sum((wanted * valid) ** 2, axis=0) / np.maximum(1, valid.sum(axis=0))
    of = [[x for x, p in zip(parts, problem.fit, strict=True) if p.recording == n] for n in recordings]
    weights = (power, np.clip(mean, (1e-9 * problem.scale) ** 2, power))
    return any(least_left(own, w) < POOR for own in of for w in weights)


def least_left(parts: Sequence[tuple[np.ndarray, np.ndarray, np.ndarray]], power: np.ndarray) -> float:
    """The share of one recording's residual power above noise that the best combination of columns leaves, 0 to 1.

    Args:
        parts: residual (n, dof) [N m], columns (n, dof, k) and valid samples (n, dof) of its segments.
        power: shape (dof,), of noise [N² m²].
    """
    weights = [valid / np.sqrt(power) for _, _, valid in parts]
    wanted = np.concatenate([(r * w).ravel() for (r, _, _), w in zip(parts, weights, strict=True)])
    columns = [(x * w[..., None]).reshape(w.size, -1) for (_, x, _), w in zip(parts, weights, strict=True)]
    noise = float(sum(valid.sum() for _, _, valid in parts))
    before, after = (float(r @ r) - noise for r in (wanted, left_beside(np.concatenate(columns), wanted)))
    return float(np.clip(after / before, 0.0, 1.0)) if before > 0.0 else 1.0


def _columns(
    problem: Problem, piece: Segment, persistent: Sequence[NamedEffect]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Residual of a segment, the columns of a load and of each effect, and which samples are valid."""
    motion = piece.motion(problem)
    residual = problem.reduce(piece, piece.tau - torque_with(motion, persistent))
    own = (problem.reduce(piece, e.added(motion))[..., None] for e in persistent)
    load = problem.reduce(piece, Payload().columns(motion, None, {}))
    return residual, np.concatenate([load, *own], axis=2), piece.counts
