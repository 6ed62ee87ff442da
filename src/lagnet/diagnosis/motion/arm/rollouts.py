"""Rollouts of the whole arm by its commands, all joints coupled: errors and block scores of laws and bodies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from lagnet.diagnosis.motion.joint.block_scores import BLOCKS, LONGEST, SHORTEST
from lagnet.diagnosis.motion.problem import MotionProblem, Run, surest_edges
from lagnet.recordings.sampling import spread_rows
from lagnet.rollout.whole_arm import roll_out_arm

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
        series, bodies = self.problem.series, self.problem.tree.bodies.copy()
        begun = {run.first: v for run, v in zip(self.problem.runs, self.problem.start_speed, strict=True)}
        if body is not None:
            bodies[-1] += body
        tree, out = replace(self.problem.tree, bodies=bodies), []
        for run in self.runs:
            rows = slice(run.first, run.last + 1)
            command, q, ratio, gain, enabled = (
                np.column_stack([getattr(s, name)[rows] for s in series])
                for name in ("command", "q", "ratio", "gain", "enabled")
            )
            v0 = begun.get(run.first, self.problem.speed[run.first])
            signals = {"v0": v0, "ratio": ratio, "gain": gain, "enabled": enabled, "surface": surface, "step": STEP}
            out.append(roll_out_arm(tree, laws, series[0].time[rows], command, q[0], **signals) - q)
        return [np.concatenate([e[:, j] for e in out]) for j in self.joints]

    def scores(self, errors: Sequence[np.ndarray], floors: np.ndarray) -> np.ndarray:
        """½ log(mean e² + floor²) of every joint in every block of time, as in `block_scores`; smaller is better."""
        time = self.problem.series[0].time
        spans = [float(time[run.last] - time[run.first]) for run in self.runs]
        length = float(np.clip(sum(spans) / BLOCKS, SHORTEST, LONGEST))
        counts, edges, out = [max(1, round(span / length)) for span in spans], [0], []
        for run in self.runs:
            edges.append(edges[-1] + run.last - run.first + 1)
        for error, floor in zip(errors, floors, strict=True):
            for count, a, b in zip(counts, edges, edges[1:], strict=False):
                out += [0.5 * np.log(np.mean(p**2) + floor**2) for p in np.array_split(error[a:b], count)]
        return np.array(out)


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
