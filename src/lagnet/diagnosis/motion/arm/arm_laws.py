"""Parameters of all joints' laws as one vector, and the errors of rollouts of the whole arm that they predict.

A parameter moves its own joint first of all, so that one rollout gives the sensitivity of one parameter of every joint
at once.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.motion.arm.fitting import DIFFERENCE
from lagnet.diagnosis.motion.arm.rollouts import ArmRuns, runs_to_fit
from lagnet.diagnosis.motion.joint.fitting import Coordinates, free_coordinates
from lagnet.diagnosis.motion.joint.joint_case import sizes_of
from lagnet.diagnosis.motion.joint.joint_diagnosis import JointDiagnosis
from lagnet.diagnosis.motion.joint.refitting import groups_of
from lagnet.diagnosis.motion.problem import MotionProblem


@dataclass(frozen=True, eq=False)
class ArmLaws:
    """Free parameters of all joints as one vector, in the joints' order.

    Args:
        runs: the rollouts.
        laws: shape (dof, len(LAW)), where they start.
        free: free parameters of each joint that has any.
        body: inertial parameters that the last link carries beside the nominal ones, shape (10,).
    """

    runs: ArmRuns
    laws: np.ndarray
    free: Mapping[int, Coordinates]
    body: np.ndarray | None = None

    @property
    def sizes(self) -> np.ndarray:
        return np.concatenate([np.zeros(0), *(c.sizes for c in self.free.values())])

    def read(self) -> np.ndarray:
        """The values of the start, shape (k,)."""
        return np.concatenate([np.zeros(0), *(c.read(self.laws[j]) for j, c in self.free.items())])

    def write(self, values: np.ndarray) -> np.ndarray:
        """The laws of given values, shape (dof, len(LAW)), within their bounds."""
        out, first = self.laws.copy(), 0
        for joint, coordinates in self.free.items():
            last = first + len(coordinates.groups)
            out[joint], first = coordinates.write(self.laws[joint], values[first:last])[0], last
        return out

    def nearest(self, values: np.ndarray) -> np.ndarray:
        """The nearest values within bounds."""
        low, high = (
            np.concatenate([np.zeros(0), *(getattr(c, b) for c in self.free.values())]) for b in ("lower", "upper")
        )
        return np.clip(values, low, high)

    def errors(self, values: np.ndarray) -> list[np.ndarray]:
        return self.runs.errors(self.write(values), self.body)

    def sensitivities(self, values: np.ndarray, here: list[np.ndarray]) -> list[np.ndarray]:
        """∂q̂_j/∂x of each joint by its own parameters in units of their sizes, each of shape (n, k)."""
        counts = [len(c.groups) for c in self.free.values()]
        first = np.cumsum([0, *counts])
        out = [np.zeros((len(e), int(first[-1]))) for e in here]
        for i in range(max(counts, default=0)):
            columns = [f + i for f, n in zip(first, counts, strict=False) if i < n]
            step = np.zeros(int(first[-1]))
            step[columns] = DIFFERENCE * self.sizes[columns]
            step = np.where(self.nearest(values + step) < values + step, -step, step)
            moved = self.errors(values + step)
            for joint, column in ((j, f + i) for j, f, n in zip(self.free, first, counts, strict=False) if i < n):
                at = self.runs.joints.index(joint)
                out[at][:, column] = (moved[at] - here[at]) / (step[column] / self.sizes[column])
        return out


def with_named_laws(laws: np.ndarray, found: Mapping[int, JointDiagnosis]) -> np.ndarray:
    """The laws of all joints, those that were diagnosed with their named ones, shape (dof, len(LAW))."""
    out = laws.copy()
    for joint, d in found.items():
        out[joint] = d.named_law
    return out


def named_arm(
    problem: MotionProblem, fitted: int, laws: np.ndarray, found: Mapping[int, JointDiagnosis]
) -> ArmLaws | None:
    """The named laws with what is free in them, None where nothing is."""
    laws, free = with_named_laws(laws, found), {}
    for joint, diagnosis in found.items():
        if groups := groups_of(diagnosis.case, diagnosis.named.effects):
            free[joint] = free_coordinates(groups, laws[joint], sizes_of(diagnosis.case.scales))
    return ArmLaws(ArmRuns(problem, runs_to_fit(problem, fitted), tuple(found)), laws, free) if free else None


def floors_of(found: Mapping[int, JointDiagnosis]) -> np.ndarray:
    return np.array([d.case.floor for d in found.values()])
