"""Rollouts of the whole arm by its commands, all joints coupled: errors and block scores of laws and bodies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.motion.block_scores import BLOCKS, LONGEST, SHORTEST
from lagnet.diagnosis.motion.problem import MotionProblem, Run
from lagnet.rollout.whole_arm import roll_out_arm

STEP = 0.004  # [s] of a rollout at most
SAMPLES = 4000  # of the runs that a fit rolls out


@dataclass(frozen=True, eq=False)
class ArmRuns:
    """Trajectories that are rolled out whole, from their first sample.

    Args:
        problem: commands, motion and nominal bodies.
        runs: those of it that are rolled out.
        joints: whose errors count.
    """

    problem: MotionProblem
    runs: tuple[Run, ...]
    joints: tuple[int, ...]

    def errors(self, laws: np.ndarray, body: np.ndarray | None = None) -> list[np.ndarray]:
        """Predicted less measured positions of each joint over all runs, each of shape (n,) [rad or m].

        Args:
            laws: shape (dof, len(LAW)).
            body: shape (10,), inertial parameters added to the last link.
        """
        series, bodies = self.problem.series, self.problem.tree.bodies.copy()
        if body is not None:
            bodies[-1] += body
        tree, out = replace(self.problem.tree, bodies=bodies), []
        for run in self.runs:
            rows = slice(run.first, run.last + 1)
            command, q, ratio, gain, enabled = (
                np.column_stack([getattr(s, name)[rows] for s in series])
                for name in ("command", "q", "ratio", "gain", "enabled")
            )
            signals = {"ratio": ratio, "gain": gain, "enabled": enabled, "step": STEP}
            out.append(roll_out_arm(tree, laws, series[0].time[rows], command, q[0], **signals) - q)
        return [np.concatenate([e[:, j] for e in out]) for j in self.joints]

    def scores(self, errors: Sequence[np.ndarray], floors: Sequence[float]) -> np.ndarray:
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
    """The first runs of the recordings that may be fitted, up to `SAMPLES`."""
    out, total = [], 0
    for run in problem.runs:
        if run.recording < fitted and (not out or total < SAMPLES):
            out.append(run)
            total += run.last - run.first + 1
    return tuple(out)


def runs_held_out(problem: MotionProblem, fitted: int) -> tuple[Run, ...]:
    """The runs of the recordings that are not fitted."""
    return tuple(run for run in problem.runs if run.recording >= fitted)
