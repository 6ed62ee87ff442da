"""Trend of the friction level over a recording, from r s(v) that the constant law leaves, recording by recording."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.effects.catalogue import effect_named
from lagnet.effects.motion import Motion
from lagnet.models.corrected.named_effects import NamedEffect, torque_with

PARTS = 8  # of a recording, each with a level of its own
CERTAIN = 8.0  # standard errors that the trend must lie off zero, of scatter about it: six degrees of freedom
NOTICED = 0.03  # of the friction: a smaller change over a recording is not reported


@dataclass(frozen=True)
class Drift:
    """A trend of one joint's friction over one fitted recording.

    Args:
        joint, recording: indices.
        change: of the friction from start to end, as a share of the fitted one.
        error: standard error of the change.
        levels: friction in the quarters of the recording, over the fitted one.
    """

    joint: int
    recording: int
    change: float
    error: float
    levels: tuple[float, ...]


def find_drifts(problem: Problem, effects: Sequence[NamedEffect]) -> tuple[Drift, ...]:
    """Trends of the named friction of each joint in each fitted recording.

    Args:
        effects: refitted, what lasts and what passes.
    """
    rubbing = [e for e in effects if effect_named(e.effect).is_friction]
    tables: dict[int, list[np.ndarray]] = {}
    for piece in problem.fit if rubbing else ():
        tables.setdefault(piece.recording, []).append(_table(problem, piece, effects, rubbing))
    found = []
    for recording, parts in tables.items():
        table = np.concatenate(parts, axis=1)
        found += [
            _trend(table[:, :, j], j, recording, problem.limits.least_share)
            for j in sorted({e.joint for e in rubbing if e.joint is not None})
        ]
    return tuple(d for d in found if d is not None)


def _table(
    problem: Problem, piece: Segment, effects: Sequence[NamedEffect], rubbing: Sequence[NamedEffect]
) -> np.ndarray:
    """Time, residual and friction torque at the valid samples, zero elsewhere, shape (3, len(keep), dof)."""
    motion = piece.motion(problem)
    residual = problem.reduce(piece, piece.tau - torque_with(motion, effects)) * piece.counts
    friction = problem.reduce(piece, _added(motion, rubbing)) * piece.counts
    return np.stack([np.broadcast_to(piece.time[piece.keep][:, None], residual.shape), residual, friction])


def _added(motion: Motion, rubbing: Sequence[NamedEffect]) -> np.ndarray:
    return sum((e.added(motion) for e in rubbing), np.zeros_like(motion.load))


def _trend(table: np.ndarray, joint: int, recording: int, least_share: float) -> Drift | None:
    """The change of a joint's friction over a recording, if it exceeds its scatter; table of shape (3, n)."""
    time, residual, friction = table
    share = (time - time[0]) / max(float(np.ptp(time)), 1e-9)
    part = np.minimum((share * PARTS).astype(int), PARTS - 1)
    weight = np.bincount(part, friction**2, PARTS)
    if np.any(weight < 0.1 * weight.mean()) or not weight.mean() > 0:
        return None  # the joint rests for a part of the time
    level = np.bincount(part, friction * residual, PARTS) / weight
    line = np.column_stack([np.ones(PARTS), (np.arange(PARTS) + 0.5) / PARTS - 0.5])
    inverse = np.linalg.inv(line.T @ (line * weight[:, None]))
    start, change = inverse @ (line.T @ (weight * level))
    scatter = float(np.sum(weight * (level - line @ [start, change]) ** 2)) / (PARTS - 2)
    error = float(np.sqrt(inverse[1, 1] * scatter))
    explained = np.sum(residual**2) - np.sum((residual - friction * (start + change * (share - 0.5))) ** 2)
    if abs(change) < max(CERTAIN * error, NOTICED) or explained < least_share * np.sum(residual**2):
        return None
    quarters = np.add.reduceat(weight * level, np.arange(0, PARTS, 2)) / np.add.reduceat(weight, np.arange(0, PARTS, 2))
    return Drift(joint, recording, float(change), error, tuple(float(1.0 + x) for x in quarters))
