"""Held-out rollouts of the whole arm by three models: the nominal one, the joints' effects, and one payload."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.motion.arm.fitting import cost_of
from lagnet.diagnosis.motion.arm.rollouts import ArmRuns, runs_held_out, runs_to_fit
from lagnet.diagnosis.motion.joint.block_scores import advantage
from lagnet.diagnosis.motion.joint.joint_case import SelectionLimits
from lagnet.diagnosis.motion.joint.joint_diagnosis import JointDiagnosis
from lagnet.diagnosis.motion.payload.fit import (
    body_loads,
    body_of,
    fit_point_mass,
    joint_errors,
    sizes_of_point,
    starts_of_point,
)
from lagnet.diagnosis.motion.problem import MotionProblem
from lagnet.servos.nominal import NominalServo

ARM_ITERATIONS = 6  # of the fit by rollouts of the whole arm, which starts where that joint by joint ended


@dataclass(frozen=True, eq=False)
class PayloadComparison:
    """A payload against the nominal arm and against the effects of its joints, on the same held-out blocks.

    Args:
        point: (m, h), shape (4,), and `sizes`, their typical sizes.
        floors: resolution of each joint's errors [rad].
        nominal, loaded: held-out errors of each joint, each of shape (n,) [rad or m].
        gain, errors: of the payload's score over the nominal arm, and that gain over its standard error.
        lead, lead_errors: the same over the effects joint by joint.
    """

    point: np.ndarray
    sizes: np.ndarray
    floors: np.ndarray
    nominal: list[np.ndarray]
    loaded: list[np.ndarray]
    gain: float
    errors: float
    lead: float
    lead_errors: float

    def needed(self, limits: SelectionLimits) -> bool:
        """Whether the payload predicts better than the nominal arm, and leaves no large error of a joint."""
        return self.gain >= limits.gain and self.errors >= limits.errors and self._explains(limits)

    def as_good(self, limits: SelectionLimits) -> bool:
        """Whether it predicts as well as the effects joint by joint, or to one step of the encoders."""
        return self.lead > -limits.gain or self.lead_errors > -limits.tie or self._within_step()

    def better(self, limits: SelectionLimits) -> bool:
        """Whether it predicts better than the effects joint by joint."""
        return self.lead > limits.gain and self.lead_errors > limits.errors

    def _explains(self, limits: SelectionLimits) -> bool:
        """Whether no joint keeps most of a large error: then another cause acts there."""
        rows = zip(_sizes(self.nominal), _sizes(self.loaded), self.floors, strict=True)
        return all(a <= max(limits.remainder * b, limits.unexplained * f) for b, a, f in rows)

    def _within_step(self) -> bool:
        """Whether every joint is predicted to one step of its encoder, two floors: nothing is left to say there."""
        return all(e <= 2.0 * f for e, f in zip(_sizes(self.loaded), self.floors, strict=True))


def compare_payload(
    problem: MotionProblem, fitted: int, servo: NominalServo, found: Mapping[int, JointDiagnosis]
) -> PayloadComparison:
    """The payload that fits best, compared on held-out motion.

    Args:
        problem: all recordings, the first `fitted` of them fitted.
        fitted: number of them.
        servo: the nominal one.
        found: diagnoses of the joints without a payload.
    """
    point, sizes = _fitted_point(problem, fitted, servo, found)
    floors = np.array([d.case.floor for d in found.values()])
    held = ArmRuns(problem, runs_held_out(problem, fitted), tuple(found))
    by_joint = servo.laws.copy()
    for joint, diagnosis in found.items():
        by_joint[joint] = diagnosis.named_law
    models = ((servo.laws, None), (by_joint, None), (servo.laws, body_of(point)))
    nominal, joints, loaded = (held.errors(laws, body) for laws, body in models)
    before, apart, after = (held.scores(e, floors) for e in (nominal, joints, loaded))
    return PayloadComparison(point, sizes, floors, nominal, loaded, *advantage(before, after), *advantage(apart, after))


def _fitted_point(
    problem: MotionProblem, fitted: int, servo: NominalServo, found: Mapping[int, JointDiagnosis]
) -> tuple[np.ndarray, np.ndarray]:
    """(m, h) and its sizes: first joint by joint, which is fast, then by rollouts of the whole arm."""
    cases, floors = {j: d.case for j, d in found.items()}, np.array([d.case.floor for d in found.values()])
    sizes, apart = sizes_of_point(problem), joint_errors(cases, body_loads(problem))
    start = min(starts_of_point(problem, sizes), key=lambda p: cost_of(apart(p), 10.0 * floors))
    point = fit_point_mass(apart, start, sizes, floors)
    fit = ArmRuns(problem, runs_to_fit(problem, fitted), tuple(found))
    whole = fit_point_mass(lambda p: fit.errors(servo.laws, body_of(p)), point, sizes, floors, ARM_ITERATIONS)
    return whole, sizes


def _sizes(errors: list[np.ndarray]) -> list[float]:
    return [float(np.sqrt(np.mean(e**2))) for e in errors]
