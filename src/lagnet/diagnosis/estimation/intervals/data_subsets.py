"""Subsets and weightings of the fitted motion: one law must give the same parameters on all of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import NamedEffect

GROUPS = 3  # of recordings: each is left out in turn


@dataclass(frozen=True, eq=False)
class MotionPart:
    """A subset of the valid samples.

    Args:
        rows: of each piece, shape (len(keep), dof), True for what belongs to it.
        speaks_for: for each effect, whether its law may be judged by this part.
    """

    rows: tuple[np.ndarray, ...]
    speaks_for: np.ndarray


def parts_of(problem: Problem, pieces: Sequence[Segment], effects: Sequence[NamedEffect]) -> Iterator[MotionPart]:
    """Subsets without some recordings, without one joint, and halves of the motion of each joint that has an effect.

    Halves are the slow and the fast one, that under small and under large load, that with little and with much
    acceleration, and that soon and long after a reversal. Joints are left out for effects that reach several.
    """
    for rows in _recordings_left_out(pieces):
        yield MotionPart(rows, np.ones(len(effects), dtype=bool))
    reaching = np.array([effect_named(e.effect).reaches_all for e in effects])
    if reaching.any() and problem.n_dof > 1:
        for joint in range(problem.n_dof):
            others = np.arange(problem.n_dof) != joint
            yield MotionPart(tuple(np.broadcast_to(others, p.counts.shape) for p in pieces), reaching)
    for joint in sorted({e.joint for e in effects if e.joint is not None}):
        own = np.array([e.joint == joint for e in effects])
        for rows in _halves(problem, pieces, joint):
            yield MotionPart(rows, own)


def _recordings_left_out(pieces: Sequence[Segment]) -> Iterator[tuple[np.ndarray, ...]]:
    names = sorted({p.recording for p in pieces})
    group_of = {name: rank % GROUPS for rank, name in enumerate(names)}
    groups = set(group_of.values())
    for group in sorted(groups) if len(groups) > 1 else ():
        yield tuple(np.full(p.counts.shape, group_of[p.recording] != group) for p in pieces)


def _halves(problem: Problem, pieces: Sequence[Segment], joint: int) -> Iterator[tuple[np.ndarray, ...]]:
    signals = [
        [np.abs(p.v[p.keep, joint]) for p in pieces],
        [np.abs(p.load[p.keep, joint]) for p in pieces],
        [np.abs(p.a[p.keep, joint]) for p in pieces],
        [travel(p.q[:, joint], p.v[:, joint], problem.slow[joint])[p.keep] for p in pieces],
    ]
    for signal in signals:
        middle = float(np.median(np.concatenate(signal)))
        for upper in (True, False):
            halves = ((s > middle) == upper for s in signal)
            yield tuple(np.broadcast_to(h[:, None], p.counts.shape) for h, p in zip(halves, pieces, strict=True))


def travel(q: np.ndarray, v: np.ndarray, slow: float) -> np.ndarray:
    """|q − q(last reversal)|, shape (n,) [rad]; motion slower than `slow` is no new direction."""
    moving = np.abs(v) > slow
    index = np.arange(v.size)
    direction = np.where(moving, np.sign(v), 0.0)[np.maximum.accumulate(np.where(moving, index, 0))]
    turned = np.diff(direction, prepend=direction[:1]) != 0
    return np.abs(q - q[np.maximum.accumulate(np.where(turned, index, 0))])
