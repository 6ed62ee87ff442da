"""One body that the last link carries, against what the joints say one by one, by rollouts of the whole arm.

A payload changes load and inertia of every joint before it, each by another factor: joint by joint it is told as other
loads, gains and rotors. It is preferred where it predicts held-out motion as well with fewer effects. Stiffness of the
nominal servos sets the scale of its torque: where no gain is given, mass and gain are confounded and it is not judged.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.motion.arm_rollout import ArmRuns, runs_held_out, runs_to_fit
from lagnet.diagnosis.motion.block_scores import advantage
from lagnet.diagnosis.motion.joint_case import SelectionLimits
from lagnet.diagnosis.motion.joint_diagnosis import JointDiagnosis
from lagnet.diagnosis.motion.payload_fit import (
    body_loads,
    body_of,
    cost_of,
    fit_point_mass,
    joint_errors,
    sizes_of_point,
    starts_of_point,
)
from lagnet.diagnosis.motion.payload_interval import point_intervals
from lagnet.diagnosis.motion.problem import MotionProblem
from lagnet.diagnosis.motion.refitting import refit
from lagnet.diagnosis.motion.selection import Rejected
from lagnet.servos.nominal import NominalServo
from lagnet.servos.parameters import INDEX

ALIKE = frozenset({"load_error", "gain_error", "rotor_inertia", "joint_spring"})  # that one joint can take for a load
REMAINDER = "remainder"


@dataclass(frozen=True, eq=False)
class PayloadFound:
    """A payload at the last link.

    Args:
        values: m [kg] and c [m] in the last joint's frame.
        intervals: 95 %, by name.
        tied: effects of one joint that predict as well.
        gain, errors: of the held-out score over the nominal model, and that gain over its standard error.
        lead: of the held-out score over the effects joint by joint.
        lead_errors: that lead over its standard error.
        power: mean squared held-out error over the variance of the motion, without and with it.
    """

    values: Mapping[str, float]
    intervals: Mapping[str, tuple[float, float]]
    tied: tuple[str, ...]
    gain: float
    errors: float
    lead: float
    lead_errors: float
    power: tuple[float, float]
    body: np.ndarray


def judge_payload(
    problem: MotionProblem,
    fitted: int,
    servo: NominalServo,
    found: Mapping[int, JointDiagnosis],
    limits: SelectionLimits,
) -> tuple[PayloadFound | None, dict[int, JointDiagnosis]]:
    """The payload, None where the motion asks for none, and the joints' diagnoses beside it.

    Args:
        problem: all recordings, the first `fitted` of them fitted.
        fitted: number of them.
        servo: the nominal one.
        found: diagnoses of the joints without a payload.
        limits: where effects are named.
    """
    known = {j: d for j, d in found.items() if servo.known[j]}
    stated = sum(_stated(d) for d in known.values())
    if not stated or len(known) != len(found):
        return None, dict(found)
    point, sizes = _fitted_point(problem, fitted, servo, known)
    floors = [d.case.floor for d in known.values()]
    held = ArmRuns(problem, runs_held_out(problem, fitted), tuple(known))
    by_joint = servo.laws.copy()
    for joint, diagnosis in known.items():
        by_joint[joint] = diagnosis.named_law
    nominal, joints, loaded = (
        held.errors(laws, body) for laws, body in ((servo.laws, None), (by_joint, None), (servo.laws, body_of(point)))
    )
    before, apart, after = (held.scores(e, floors) for e in (nominal, joints, loaded))
    gain, errors = advantage(before, after)
    lead, lead_errors = advantage(apart, after)
    if gain < limits.gain or errors < limits.errors or not _explains(nominal, loaded, floors, limits):
        return None, dict(found)
    as_good = lead > -limits.gain or lead_errors > -limits.tie or _within_step(loaded, floors)
    better = lead > limits.gain and lead_errors > limits.errors
    if not as_good:
        return None, dict(found)
    if stated == 1 and not better:
        return None, {j: _tied_with_payload(d) for j, d in found.items()}
    fit = ArmRuns(problem, runs_to_fit(problem, fitted), tuple(known))
    values, intervals = point_intervals(fit, servo.laws, point, sizes, np.array(floors))
    variance = max(float(np.mean([np.var(problem.series[j].q) for j in known])), 1e-12)
    power = tuple(float(np.mean([np.mean(e**2) for e in x])) / variance for x in (nominal, loaded))
    tied = _alike_at_one_joint(known, loaded, limits)
    payload = PayloadFound(
        values, intervals, tied, gain, errors, lead, lead_errors, (power[0], power[1]), body_of(point)
    )
    return payload, {j: _explained(d, lead, -limits.gain) for j, d in found.items()}


def _stated(found: JointDiagnosis) -> int:
    """Effects that a joint names, and those that a large remainder alone kept from being named."""
    return len(found.named.effects) + sum(r.rule == REMAINDER for r in found.rejected)


def _fitted_point(
    problem: MotionProblem, fitted: int, servo: NominalServo, known: Mapping[int, JointDiagnosis]
) -> tuple[np.ndarray, np.ndarray]:
    """(m, h) and its sizes: first joint by joint, which is fast, then by rollouts of the whole arm."""
    cases, floors = {j: d.case for j, d in known.items()}, np.array([d.case.floor for d in known.values()])
    sizes, apart = sizes_of_point(problem), joint_errors(cases, body_loads(problem))
    start = min(starts_of_point(problem, sizes), key=lambda p: cost_of(apart(p), 10.0 * floors))
    point = fit_point_mass(apart, start, sizes, floors)
    fit = ArmRuns(problem, runs_to_fit(problem, fitted), tuple(known))
    return fit_point_mass(lambda p: fit.errors(servo.laws, body_of(p)), point, sizes, floors, 6), sizes


def _explains(before: list[np.ndarray], after: list[np.ndarray], floors: list[float], limits: SelectionLimits) -> bool:
    """Whether no joint keeps most of a large error: then another cause acts there."""
    sizes = [[float(np.sqrt(np.mean(e**2))) for e in x] for x in (before, after)]
    rows = zip(*sizes, floors, strict=True)
    return all(a <= max(limits.remainder * b, limits.unexplained * f) for b, a, f in rows)


def _within_step(errors: list[np.ndarray], floors: list[float]) -> bool:
    """Whether every joint is predicted to one step of its encoder, two floors: nothing is left to say there."""
    return all(float(np.sqrt(np.mean(e**2))) <= 2.0 * f for e, f in zip(errors, floors, strict=True))


def _alike_at_one_joint(
    known: Mapping[int, JointDiagnosis], loaded: list[np.ndarray], limits: SelectionLimits
) -> tuple[str, ...]:
    """For an arm of one joint: a load of another size beside a rotor, where it predicts as well."""
    if len(known) != 1:
        return ()
    (diagnosis,) = known.values()
    case = diagnosis.case
    law = case.law.copy()
    law[INDEX["load_gain"]] = 1.3
    scale = 2.0 * case.floor
    rival = refit(case, ("load_error", "rotor_inertia"), law, scale, 30)
    error = float(np.sqrt(np.mean(case.validation.errors(rival.law) ** 2)))
    own = float(np.sqrt(np.mean(loaded[0] ** 2)))
    return ("load_error",) if error < max((1.0 + limits.gain) * own, limits.unexplained * case.floor) else ()


def _tied_with_payload(found: JointDiagnosis) -> JointDiagnosis:
    tied = tuple(replace(c, tied=(*c.tied, "payload")) if ALIKE & {c.effect, *c.tied} else c for c in found.comparisons)
    return replace(found, comparisons=tied)


def _explained(found: JointDiagnosis, lead: float, limit: float) -> JointDiagnosis:
    """The diagnosis of a joint whose error the payload explains: nothing named, the nominal law."""
    law = found.case.law
    named = replace(found.named, effects=(), fitted=replace(found.named.fitted, law=law))
    rejected = tuple(Rejected(e, "explained_by_payload", lead, limit) for e in found.named.effects)
    kept = (*found.rejected, *rejected)
    return replace(found, named=named, comparisons=(), rejected=kept, intervals={}, law=law)
