"""One body that the last link carries, against what the joints say one by one, by rollouts of the whole arm.

A payload changes load and inertia of every joint before it, each by another factor: joint by joint it is told as other
loads, gains and rotors. It is preferred where it predicts held-out motion as well with fewer effects. Stiffness of the
nominal servos sets the scale of its torque: where no gain is given, mass and gain are confounded and it is not judged.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.motion.arm.rollouts import ArmRuns, runs_to_fit
from lagnet.diagnosis.motion.joint.joint_case import SelectionLimits
from lagnet.diagnosis.motion.joint.joint_diagnosis import JointDiagnosis
from lagnet.diagnosis.motion.joint.refitting import refit
from lagnet.diagnosis.motion.joint.selection import REMAINDER, Rejected
from lagnet.diagnosis.motion.payload.comparison import PayloadComparison, compare_payload
from lagnet.diagnosis.motion.payload.fit import body_of
from lagnet.diagnosis.motion.payload.found import PayloadFound
from lagnet.diagnosis.motion.payload.interval import point_intervals
from lagnet.diagnosis.motion.problem import MotionProblem
from lagnet.servos.nominal import NominalServo
from lagnet.servos.parameters import INDEX

ALIKE = frozenset({"load_error", "gain_error", "rotor_inertia", "joint_spring"})  # that one joint can take for a load


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
    stated = sum(_stated(d) for d in found.values())
    if not stated or not all(servo.known[j] for j in found):
        return None, dict(found)
    compared = compare_payload(problem, fitted, servo, found)
    if not compared.needed(limits) or not compared.as_good(limits):
        return None, dict(found)
    if stated == 1 and not compared.better(limits):
        return None, {j: _tied_with_payload(d) for j, d in found.items()}
    payload = _payload(problem, fitted, servo, found, compared, limits)
    return payload, {j: _explained(d, compared.lead, -limits.gain) for j, d in found.items()}


def _stated(found: JointDiagnosis) -> int:
    """Effects that a joint names, and those that a large remainder alone kept from being named."""
    return len(found.named.effects) + sum(r.rule == REMAINDER for r in found.rejected)


def _payload(
    problem: MotionProblem,
    fitted: int,
    servo: NominalServo,
    found: Mapping[int, JointDiagnosis],
    compared: PayloadComparison,
    limits: SelectionLimits,
) -> PayloadFound:
    """The payload with its intervals and ties."""
    fit = ArmRuns(problem, runs_to_fit(problem, fitted), tuple(found))
    values, intervals = point_intervals(fit, servo.laws, compared.point, compared.sizes, compared.floors)
    variance = max(float(np.mean([np.var(problem.series[j].q) for j in found])), 1e-12)
    before, after = (float(np.mean([np.mean(e**2) for e in x])) for x in (compared.nominal, compared.loaded))
    return PayloadFound(
        values=values,
        intervals=intervals,
        tied=_alike_at_one_joint(found, compared.loaded, limits),
        gain=compared.gain,
        errors=compared.errors,
        lead=compared.lead,
        lead_errors=compared.lead_errors,
        power=(before / variance, after / variance),
        body=body_of(compared.point),
    )


def _alike_at_one_joint(
    found: Mapping[int, JointDiagnosis], loaded: list[np.ndarray], limits: SelectionLimits
) -> tuple[str, ...]:
    """For an arm of one joint: a load of another size beside a rotor, where it predicts as well."""
    if len(found) != 1:
        return ()
    (diagnosis,) = found.values()
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
