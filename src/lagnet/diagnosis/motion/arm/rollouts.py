"""Rollouts of the whole arm by its commands, all joints coupled: errors and block scores of laws and bodies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from lagnet.diagnosis.motion.joint.block_scores import BLOCKS, LONGEST, SHORTEST
from lagnet.diagnosis.motion.problem import MotionProblem, Run, surest_edges
from lagnet.recordings.sampling import spread_rows
from lagnet.rollout.whole_arm import roll_out_arm
from lagnet.side_by_side import side_by_side

STEP = 0.004  # [s] of a rollout at most
SAMPLES = 8000  # that a fit rolls out
PIECE = 10.0  # [s] of a rollout where whole trajectories would be more than that


@dataclass(frozen=True, eq=False)
class ArmRuns:
    """Trajectories that are rolled out from their first sample, or pieces of them from the measured state.

    Args:
        problem: commands, motion and nominal bodies.
        runs: those of it that are rolled out.
        joints: whose errors count.
    """

    problem: MotionProblem
    runs: tuple[Run, ...]
    joints: tuple[int, ...]

    def errors(
        self, laws: np.ndarray, body: np.ndarray | None = None, surface: np.ndarray | None = None
    ) -> list[np.ndarray]:
        """Predicted less measured positions of each joint over all runs, each of shape (n,) [rad or m].

        Args:
            laws: shape (dof, len(LAW)).
            body: shape (10,), inertial parameters added to the last link.
            surface: shape (len(SURFACE),), what a point of the arm may rest on; None: nothing.
        """
        return self.of_joints(self.positions(laws, body, surface))

    def positions(
        self, laws: np.ndarray, body: np.ndarray | None = None, surface: np.ndarray | None = None
    ) -> list[np.ndarray]:
        """Predicted positions of all joints in every run, each of shape (samples, dof) [rad or m]; args of `errors`."""
        return self.positions_in(range(len(self.runs)), laws, body, surface)

    def positions_in(
        self, which: Sequence[int], laws: np.ndarray, body: np.ndarray | None, surface: np.ndarray | None
    ) -> list[np.ndarray]:
        """`positions` in some of the runs, by their places among them."""
        bodies = self.problem.tree.bodies.copy()
        if body is not None:
            bodies[-1] += body
        tree = replace(self.problem.tree, bodies=bodies)

        def rolled(i: int) -> np.ndarray:
            d = self._driven[i]
            signals = {"v0": d.v0, "ratio": d.ratio, "gain": d.gain, "enabled": d.enabled}
            return roll_out_arm(tree, laws, d.time, d.command, d.q[0], **signals, surface=surface, step=STEP)

        return side_by_side(rolled, which)

    def of_joints(self, positions: Sequence[np.ndarray]) -> list[np.ndarray]:
        """Predicted less measured positions of each joint over all runs, each of shape (n,), of `positions`."""
        errors = [p - d.q for p, d in zip(positions, self._driven, strict=True)]
        return [np.concatenate([e[:, j] for e in errors]) for j in self.joints]

    @cached_property
    def _driven(self) -> list[_Driven]:
        begun = {run.first: v for run, v in zip(self.problem.runs, self.problem.start_speed, strict=True)}
        out = []
        for run in self.runs:
            rows = slice(run.first, run.last + 1)
            signals = (
                np.column_stack([getattr(s, name)[rows] for s in self.problem.series])
                for name in ("command", "q", "ratio", "gain", "enabled")
            )
            v0 = begun.get(run.first, self.problem.speed[run.first])
            out.append(_Driven(self.problem.series[0].time[rows], v0, *signals))
        return out

    def seconds(self, run: Run) -> float:
        """Duration of a run."""
        time = self.problem.series[0].time
        return float(time[run.last] - time[run.first])

    def scores(self, errors: Sequence[np.ndarray], floors: np.ndarray) -> np.ndarray:
        """½ log(mean e² + floor²) of every joint in every block of time, as in `block_scores`; smaller is better."""
        spans = [self.seconds(run) for run in self.runs]
        length = float(np.clip(sum(spans) / BLOCKS, SHORTEST, LONGEST))
        counts, edges, out = [max(1, round(span / length)) for span in spans], [0], []
        for run in self.runs:
            edges.append(edges[-1] + run.last - run.first + 1)
        for error, floor in zip(errors, floors, strict=True):
            for count, a, b in zip(counts, edges, edges[1:], strict=False):
                out += [0.5 * np.log(np.mean(p**2) + floor**2) for p in np.array_split(error[a:b], count)]
        return np.array(out)


@dataclass(frozen=True, eq=False)
class _Driven:
    """What a run is rolled out by: time (n,), speed of the joints at its begin (dof,), and signals (n, dof)."""

    time: np.ndarray
    v0: np.ndarray
    command: np.ndarray
    q: np.ndarray
    ratio: np.ndarray
    gain: np.ndarray
    enabled: np.ndarray


def runs_to_fit(problem: MotionProblem, fitted: int) -> tuple[Run, ...]:
    """All trajectories that may be fitted; where they have more than `SAMPLES`, pieces from all parts of them."""
    runs = [run for run in problem.runs if run.recording < fitted]
    if sum(run.last - run.first + 1 for run in runs) <= SAMPLES:
        return tuple(runs)
    pieces = pieces_of(problem, runs)
    longest = max(piece.last - piece.first + 1 for piece in pieces)
    chosen = spread_rows(len(pieces), max(1, SAMPLES // longest))
    return tuple(pieces[i] for i in chosen)


def pieces_of(problem: MotionProblem, runs: Sequence[Run], length: float = PIECE) -> list[Run]:
    """Pieces of about `length` seconds, each from a state that is sure."""
    return [piece for run in runs for piece in _pieces(problem, run, length)]


def _pieces(problem: MotionProblem, run: Run, length: float) -> list[Run]:
    time = problem.series[0].time
    count = max(1, round(float(time[run.last] - time[run.first]) / length))
    edges = surest_edges(problem.speed[run.first : run.last + 1], count) + run.first
    return [Run(run.recording, int(a), int(b)) for a, b in pairwise(edges) if b > a]


def runs_held_out(problem: MotionProblem, fitted: int) -> tuple[Run, ...]:
    """The runs of the recordings that are not fitted."""
    return tuple(run for run in problem.runs if run.recording >= fitted)
