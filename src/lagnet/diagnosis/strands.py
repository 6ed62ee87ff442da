"""What lasting effects leave of each recording, in the order of time: where to look for what happens for a while."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.problem import Piece, Problem
from lagnet.effects.motion import Motion
from lagnet.models.corrected import NamedEffect, torque_with


@dataclass(frozen=True, eq=False)
class Strand:
    """The samples of one recording that are evidence, with what is left of their torque.

    Args:
        motion: at the samples that are kept; its recording is the fitted one that it belongs to, None for another.
        rest: shape (n, dof), torque that the model with its effects lacks, low-passed [N m].
        counts: shape (n, dof), False where a joint rests.
        index: of the recording among those fitted, or among those held out.
    """

    motion: Motion
    rest: np.ndarray
    counts: np.ndarray
    index: int

    @property
    def time(self) -> np.ndarray:
        """Clock of the recording at the samples, shape (n,) [s]."""
        return self.motion.time

    def thinned(self, step: int) -> Strand:
        """Every so many of the samples."""
        m, rows = self.motion, slice(None, None, step)
        motion = replace(m, time=m.time[rows], q=m.q[rows], v=m.v[rows], a=m.a[rows], load=m.load[rows], cache={})
        return Strand(motion, self.rest[rows], self.counts[rows], self.index)


def strands_of(problem: Problem, pieces: Sequence[Piece], effects: Sequence[NamedEffect]) -> tuple[Strand, ...]:
    """One strand for each recording among the pieces."""
    parts: dict[int, list[tuple[Piece, np.ndarray]]] = {}
    for piece in pieces:
        rest = problem.reduce(piece, piece.tau - torque_with(piece.motion(problem), effects))
        parts.setdefault(piece.recording, []).append((piece, rest))
    return tuple(_joined(problem, index, found) for index, found in parts.items())


def _joined(problem: Problem, index: int, found: list[tuple[Piece, np.ndarray]]) -> Strand:
    names = ("time", "q", "v", "a", "load")
    time, q, v, a, load = (np.concatenate([getattr(p, n)[p.keep] for p, _ in found]) for n in names)
    motion = Motion(
        time, q, v, a, load, problem.slow, problem.nominal, None, None, found[0][0].origin, problem.straight
    )
    counts = np.concatenate([p.counts for p, _ in found])
    return Strand(motion, np.concatenate([r for _, r in found]), counts, index)
