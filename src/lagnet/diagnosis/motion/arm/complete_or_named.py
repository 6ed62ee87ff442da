"""Complete laws of joints against their named laws, by rollouts of the whole arm."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.motion.arm.arm_laws import with_named_laws
from lagnet.diagnosis.motion.arm.rollouts import ArmRuns, runs_held_out
from lagnet.diagnosis.motion.joint.joint_diagnosis import JointDiagnosis
from lagnet.diagnosis.motion.problem import MotionProblem
from lagnet.servos.parameters import GAP, STIFFNESS


def no_worse_than_named(
    problem: MotionProblem, fitted: int, laws: np.ndarray, found: Mapping[int, JointDiagnosis]
) -> dict[int, JointDiagnosis]:
    """The diagnoses, with the named law of a joint as its complete one where that predicts its held-out motion better.

    A complete law is fitted joint by joint, under loads along the measured motion; a named one by the whole arm. Each
    joint is judged beside the laws that its neighbours keep, as their motion is its load. Where one rigid joint moves
    alone both are the same rollouts, between which its own diagnosis has decided already.

    Args:
        problem: all recordings, the first `fitted` of them fitted.
        fitted: number of them.
        laws: nominal, shape (dof, len(LAW)), for joints that do not move.
        found: diagnoses of the joints that do.
    """
    complete, named = laws.copy(), with_named_laws(laws, found)
    for joint, d in found.items():
        complete[joint] = d.law
    alone = len(found) == 1 and not named[:, [STIFFNESS, GAP]].any()
    if alone or np.array_equal(complete, named):
        return dict(found)
    held = ArmRuns(problem, runs_held_out(problem, fitted), tuple(found))
    floors = np.array([d.case.floor for d in found.values()])

    def scores(arm: np.ndarray) -> list[np.ndarray]:
        return np.split(held.scores(held.errors(arm), floors), len(found))

    used, before = complete, scores(complete)
    for at, joint in enumerate(found):
        if np.array_equal(used[joint], named[joint]):
            continue
        other = used.copy()
        other[joint] = named[joint]
        after = scores(other)
        if float(np.mean(before[at] - after[at])) > 0.0:
            used, before = other, after
    return {j: replace(d, law=d.named_law) if np.array_equal(used[j], named[j]) else d for j, d in found.items()}
