"""What the named effects leave at each joint, how much of it can be predicted, and the plainest formula that does."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from lagnet.diagnosis.ceiling import Ceiling, Signals, find_ceiling, signals_of
from lagnet.diagnosis.leftover_shape import LeftoverShape, find_shape
from lagnet.diagnosis.problem import Piece, Problem
from lagnet.models.corrected import torque_with

if TYPE_CHECKING:
    from lagnet.diagnosis.inquiry import Inquiry

HALVES = 6  # parts of the fitted motion that predict as many others
ABOVE = 1.25  # residual over noise, root mean squares, from which a mismatch is significant


@dataclass(frozen=True, eq=False)
class Leftover:
    """What the refitted effects leave, on the samples that count.

    Args:
        fit, holdout: (residual, counts), each of shape (n, dof).
        seen, unseen: what a flexible model may look at, on the same samples.
    """

    fit: tuple[np.ndarray, np.ndarray]
    holdout: tuple[np.ndarray, np.ndarray]
    seen: Signals
    unseen: Signals


@dataclass(frozen=True, eq=False)
class JointLeftover:
    """What is left at one joint.

    Args:
        above: whether it exceeds the noise, on held-out motion or, where that does not reach it, on the fitted one.
        power: mean square on held-out samples [N² m²].
        share: of the joint's mismatch beyond the noise that is left, on the motion where it exceeds it, 0 to 1.
        ceiling: how much of it any smooth function predicts; nothing where it is noise.
        shape: how it looks against its strongest signal; None where it is noise or nothing predicts it.
    """

    above: bool
    power: float
    share: float
    ceiling: Ceiling
    shape: LeftoverShape | None


def left_over(inquiry: Inquiry) -> Leftover:
    """Residuals of the corrected model on fit and held-out samples."""
    problem, parts = inquiry.problem, []
    for pieces in (problem.fit, problem.holdout):
        blind = [replace(p.motion(problem), recorded=None) for p in pieces]  # a prediction sees no recorded torque
        predicted = [torque_with(m, inquiry.effects) for m in blind]
        rest = [problem.reduce(p, p.tau - t) for p, t in zip(pieces, predicted, strict=True)]
        parts.append((np.concatenate(rest), np.concatenate([p.counts for p in pieces])))
    seen, unseen = signals_of(problem, problem.fit), signals_of(problem, problem.holdout)
    return Leftover(parts[0], parts[1], seen, unseen)


def joint_leftovers(inquiry: Inquiry, after: Leftover) -> tuple[JointLeftover, ...]:
    """Each joint's part of what is left."""
    return tuple(_joint(inquiry, after, j) for j in range(inquiry.problem.n_dof))


def missed_by(inquiry: Inquiry) -> np.ndarray:
    """Torque beyond noise that the corrected model misses on held-out motion, root mean square, shape (dof,) [N m]."""
    power = np.array([joint.power for joint in inquiry.leftovers])
    return np.sqrt(np.maximum(power - inquiry.noise**2, 0.0))


def stacked(problem: Problem, pieces: Sequence[Piece]) -> tuple[np.ndarray, np.ndarray]:
    """Residual of the nominal model and which samples count, shape (n, dof)."""
    rest = np.concatenate([problem.residual(p) for p in pieces])
    return rest, np.concatenate([p.counts for p in pieces])


def power_of(residual: np.ndarray, counts: np.ndarray, joint: int) -> float:
    """Mean square of a joint's residual over the samples that count [N² m²]."""
    return float(np.sum((residual[:, joint] * counts[:, joint]) ** 2) / max(1, counts[:, joint].sum()))


def _joint(inquiry: Inquiry, after: Leftover, joint: int) -> JointLeftover:
    power, fitted = power_of(*after.holdout, joint), power_of(*after.fit, joint)
    limit, problem = (ABOVE * inquiry.noise[joint]) ** 2, inquiry.problem
    if max(power, fitted) <= limit:
        return JointLeftover(False, power, 0.0, Ceiling(0.0, ()), None)
    pieces, there = (problem.holdout, power) if power > limit else (problem.fit, fitted)
    looks = _look_at(inquiry, after, joint) if power > limit else (Ceiling(0.0, ()), None)
    if not looks[0].depends_on and fitted > limit:  # held-out motion may be too short, or too unlike, to learn it for
        looks = _look_at(inquiry, _within_fit(after), joint)
    return JointLeftover(True, power, _share(inquiry, pieces, there, joint), *looks)


def _share(inquiry: Inquiry, pieces: Sequence[Piece], power: float, joint: int) -> float:
    before, noise = power_of(*stacked(inquiry.problem, pieces), joint), float(inquiry.noise[joint] ** 2)
    return float(np.clip(max(0.0, power - noise) / max(before - noise, 1e-300), 0.0, 1.0))


def _within_fit(after: Leftover) -> Leftover:
    """The fitted motion alone: every second part of it is predicted from the others."""
    rest, counts = after.fit
    seen, unseen = every_second_part(len(rest))
    halves = [(rest[rows], counts[rows]) for rows in (seen, unseen)]
    return Leftover(halves[0], halves[1], after.seen.only(seen), after.seen.only(unseen))


def every_second_part(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Rows of every second of a few parts of n samples in order, and all other rows."""
    parts = np.array_split(np.arange(n), 2 * HALVES)
    return np.concatenate(parts[0::2]), np.concatenate(parts[1::2])


def _look_at(inquiry: Inquiry, after: Leftover, joint: int) -> tuple[Ceiling, LeftoverShape | None]:
    (rest, counts), (test, test_counts) = after.fit, after.holdout
    seen, truth = rest[:, joint], test[:, joint] * test_counts[:, joint]
    ceiling = find_ceiling(after.seen, seen, counts[:, joint], after.unseen, truth, inquiry.seed)
    shape = None
    if ceiling.depends_on:
        signals = (after.seen.only(counts[:, joint]), after.unseen.only(test_counts[:, joint]))
        rests = (seen[counts[:, joint]], test[test_counts[:, joint], joint])
        shape = find_shape(signals, rests, ceiling.depends_on, inquiry.problem.slow)
    return ceiling, shape
