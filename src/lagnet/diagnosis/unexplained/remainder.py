"""r after all named effects: its power at each joint, its predictable share, and a formula where a simple one holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.problem.residuals import power_of, stacked
from lagnet.diagnosis.unexplained.formula import RemainderShape, find_shape
from lagnet.diagnosis.unexplained.predictability import Examples, Predictability, Signals, predictability_of, signals_of
from lagnet.models.corrected.named_effects import NamedEffect, torque_with

HALVES = 6  # parts of the fitted motion that predict as many others


@dataclass(frozen=True, eq=False)
class Remainder:
    """Residual r of the corrected model, with the signals that may predict it.

    Args:
        fit, holdout: (residual, valid), each of shape (n, dof).
        seen, unseen: what a flexible model may look at, on the same samples.
    """

    fit: tuple[np.ndarray, np.ndarray]
    holdout: tuple[np.ndarray, np.ndarray]
    seen: Signals
    unseen: Signals


@dataclass(frozen=True)
class RemainderSize:
    """How much of one joint's torque remains.

    Args:
        above: whether it exceeds the noise, on held-out motion or, if not there, on the fitted one.
        power: mean square on held-out samples [N² m²].
        fitted: mean square on fitted samples [N² m²].
        share: of the joint's mismatch beyond the noise that is left, on the motion where it exceeds it, 0 to 1.
    """

    above: bool
    power: float
    fitted: float
    share: float


@dataclass(frozen=True, eq=False)
class JointRemainder:
    """The remainder of one joint.

    Args:
        size: how much it is.
        predictability: how much of it any smooth function predicts; nothing where it is noise.
        shape: how it looks against its strongest signal; None where it is noise or nothing predicts it.
    """

    size: RemainderSize
    predictability: Predictability
    shape: RemainderShape | None


def remainder_of(problem: Problem, effects: Sequence[NamedEffect]) -> Remainder:
    """Residuals of the corrected model on fit and held-out samples."""
    parts = []
    for pieces in (problem.fit, problem.holdout):
        blind = [replace(p.motion(problem), recorded=None) for p in pieces]  # a prediction has no recorded torque
        predicted = [torque_with(m, effects) for m in blind]
        residual = [problem.reduce(p, p.tau - t) for p, t in zip(pieces, predicted, strict=True)]
        parts.append((np.concatenate(residual), np.concatenate([p.counts for p in pieces])))
    seen, unseen = signals_of(problem, problem.fit), signals_of(problem, problem.holdout)
    return Remainder(parts[0], parts[1], seen, unseen)


def remainder_sizes(problem: Problem, after: Remainder, noise: np.ndarray) -> tuple[RemainderSize, ...]:
    """How much remains at each joint.

    Args:
        noise: shape (dof,), noise floor [N m].
    """
    nominal = {part: stacked(problem, pieces) for part, pieces in (("holdout", problem.holdout), ("fit", problem.fit))}
    return tuple(_size(problem, after, nominal, float(noise[j]), j) for j in range(problem.n_dof))


def _size(
    problem: Problem, after: Remainder, nominal: dict[str, tuple[np.ndarray, np.ndarray]], noise: float, joint: int
) -> RemainderSize:
    power, fitted = power_of(*after.holdout, joint), power_of(*after.fit, joint)
    limit = (problem.limits.above_noise * noise) ** 2
    if max(power, fitted) <= limit:
        return RemainderSize(False, power, fitted, 0.0)
    part, there = ("holdout", power) if power > limit else ("fit", fitted)
    before = power_of(*nominal[part], joint)
    share = float(np.clip(max(0.0, there - noise**2) / max(before - noise**2, 1e-300), 0.0, 1.0))
    return RemainderSize(True, power, fitted, share)


def joint_remainders(
    problem: Problem, after: Remainder, sizes: Sequence[RemainderSize], noise: np.ndarray, seed: int
) -> tuple[JointRemainder, ...]:
    """The remainder of each joint, and what predicts it.

    Args:
        noise: shape (dof,), noise floor [N m].
    """
    limits = (problem.limits.above_noise * noise) ** 2
    looks = (_look(problem, after, size, float(limits[j]), seed, j) for j, size in enumerate(sizes))
    return tuple(JointRemainder(size, look[0], look[1]) for size, look in zip(sizes, looks, strict=True))


def _look(
    problem: Problem, after: Remainder, size: RemainderSize, limit: float, seed: int, joint: int
) -> tuple[Predictability, RemainderShape | None]:
    looks = (Predictability(0.0, ()), None)
    if size.power > limit:
        looks = _look_at(after, joint, problem.slow, seed)
    if (
        not looks[0].depends_on and size.fitted > limit
    ):  # held-out motion may be too short, or too unlike, to learn it for
        looks = _look_at(_within_fit(after), joint, problem.slow, seed)
    return looks


def _within_fit(after: Remainder) -> Remainder:
    """The fitted motion alone: every second part of it is predicted from the others."""
    residual, valid = after.fit
    seen, unseen = every_second_part(len(residual))
    halves = [(residual[rows], valid[rows]) for rows in (seen, unseen)]
    return Remainder(halves[0], halves[1], after.seen.only(seen), after.seen.only(unseen))


def every_second_part(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Rows of every second of a few parts of n samples in order, and all other rows."""
    parts = np.array_split(np.arange(n), 2 * HALVES)
    return np.concatenate(parts[0::2]), np.concatenate(parts[1::2])


def _look_at(after: Remainder, joint: int, slow: np.ndarray, seed: int) -> tuple[Predictability, RemainderShape | None]:
    (residual, valid), (test, test_valid) = after.fit, after.holdout
    seen, truth = residual[:, joint], test[:, joint] * test_valid[:, joint]
    examples = Examples(joint, after.seen, seen, valid[:, joint], after.unseen, truth)
    predictability = predictability_of(examples, seed)
    shape = None
    if predictability.depends_on:
        signals = (after.seen.only(valid[:, joint]), after.unseen.only(test_valid[:, joint]))
        residuals = (seen[valid[:, joint]], test[test_valid[:, joint], joint])
        shape = find_shape(signals, residuals, predictability.depends_on, slow)
    return predictability, shape
