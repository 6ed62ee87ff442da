"""The laws of the named effects fitted to rollouts of the whole arm, and their intervals.

Selection rolls out one joint while the others move as measured, whose accelerations are smoothed: that is fast, and
biases values by a percent or two. Here all joints are coupled and every load is the model's own. In a fit one rollout
gives the sensitivity of one parameter of every joint at once; intervals take each by itself.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.motion.arm.arm_laws import floors_of, named_arm
from lagnet.diagnosis.motion.arm.fitting import fit_values
from lagnet.diagnosis.motion.arm.profiles import profiled_ends
from lagnet.diagnosis.motion.arm.rollouts import ArmRuns, runs_held_out
from lagnet.diagnosis.motion.arm.secants import settled_secants
from lagnet.diagnosis.motion.arm.withdrawals import near_nominal, passing, refuted, undetermined, unexplained
from lagnet.diagnosis.motion.joint.block_scores import advantage, beyond_scatter
from lagnet.diagnosis.motion.joint.joint_diagnosis import JointDiagnosis
from lagnet.diagnosis.motion.joint.refitting import without
from lagnet.diagnosis.motion.joint.selection import (
    NO_GAIN,
    NOT_SIGNIFICANT,
    Rejected,
    gains_too_little,
)
from lagnet.diagnosis.motion.problem import MotionProblem
from lagnet.servos.catalogue import servo_effect

ITERATIONS = 6  # in each round: a fit joint by joint is near


def fit_named_laws(
    problem: MotionProblem, fitted: int, laws: np.ndarray, found: Mapping[int, JointDiagnosis]
) -> dict[int, JointDiagnosis]:
    """The diagnoses with values and intervals by the whole arm, less effects whose values are the nominal ones there.

    Args:
        problem: all recordings, the first `fitted` of them fitted.
        fitted: number of them.
        laws: nominal, shape (dof, len(LAW)), for joints that do not move.
        found: diagnoses joint by joint.
    """
    out = _refitted(problem, fitted, laws, found)
    while nominal := {j: near for j, d in out.items() if (near := (*near_nominal(d), *refuted(d)))}:
        out = {j: _without(d, nominal.get(j, ())) for j, d in out.items()}
        out = _refitted(problem, fitted, laws, out)
    out = _needed_beside_yielding(problem, fitted, laws, out)
    if fading := {j: left for j, d in out.items() if (left := passing(problem, fitted, j, d))}:
        out = {j: replace(_without(d, fading[j]), law=d.law) if j in fading else d for j, d in out.items()}
        out = _refitted(problem, fitted, laws, out)
    if left := unexplained(problem, fitted, laws, out):  # also those that stood in for what fades
        out = _refitted(problem, fitted, laws, {j: _without(d, left.get(j, ())) for j, d in out.items()})
    out = _with_intervals(problem, fitted, laws, out)
    if not (open_ := {j: left for j, d in out.items() if (left := undetermined(d))}):
        return out
    out = {j: replace(_without(d, open_[j]), law=d.law) if j in open_ else d for j, d in out.items()}  # names alone go
    return _with_intervals(problem, fitted, laws, out, open_)  # those of other joints, with more free, are no narrower


def _refitted(
    problem: MotionProblem, fitted: int, laws: np.ndarray, found: Mapping[int, JointDiagnosis]
) -> dict[int, JointDiagnosis]:
    """The named laws fitted to the whole arm, unless held-out motion is predicted worse by them."""
    arm, floors = named_arm(problem, fitted, laws, found), floors_of(found)
    if arm is None:
        return dict(found)
    slopes, start = arm.sensitivities, arm.read()
    values = fit_values(arm.errors, slopes, start, arm.sizes, floors, nearest=arm.nearest, iterations=ITERATIONS)
    held, new = ArmRuns(problem, runs_held_out(problem, fitted), tuple(found)), arm.write(values)
    before, after = (held.scores(held.errors(x), floors) for x in (arm.laws, new))
    if advantage(before, after)[0] < 0.0:
        return dict(found)
    return {j: _with_law(d, new[j]) for j, d in found.items()}


def _with_intervals(
    problem: MotionProblem,
    fitted: int,
    laws: np.ndarray,
    found: Mapping[int, JointDiagnosis],
    joints: Collection[int] | None = None,
) -> dict[int, JointDiagnosis]:
    """The diagnoses with 95 % intervals of every free law parameter by name, of all joints or of these."""
    arm = named_arm(problem, fitted, laws, found)
    free = {} if arm is None else {j: c for j, c in arm.free.items() if joints is None or j in joints}
    if arm is None or not free:
        return dict(found)
    arm = replace(arm, free=free)
    values = arm.read()
    here, floors = arm.errors(values), floors_of(found)
    secants = settled_secants(arm.errors, values, here, arm.sizes, floors, arm.nearest)
    low, high = profiled_ends(arm.errors, values, here, secants, arm.sizes, floors, arm.nearest)
    rows = [(j, group) for j, c in arm.free.items() for group in c.groups]
    ends: dict[int, dict[str, tuple[float, float]]] = {}
    for (joint, group), *end in zip(rows, map(float, low), map(float, high), strict=True):
        ends.setdefault(joint, {}).update(dict.fromkeys(group, (end[0], end[1])))
    return {j: replace(d, intervals=ends.get(j, d.intervals)) for j, d in found.items()}


def _needed_beside_yielding(
    problem: MotionProblem, fitted: int, laws: np.ndarray, found: Mapping[int, JointDiagnosis]
) -> dict[int, JointDiagnosis]:
    """The diagnoses less names that the whole arm predicts as well without, where a transmission yields.

    Joint by joint its neighbours are loaded by the motion that was measured; where that is the motor's and not the
    link's they lack what the link does, and take it for a cause of their own. The bar is that of a joint by itself, a
    gain beyond its scatter; of the names that fail, that of the least gain goes first.
    """
    out = dict(found)
    held, floors = ArmRuns(problem, runs_held_out(problem, fitted), tuple(out)), floors_of(out)

    def scores(diagnoses: Mapping[int, JointDiagnosis]) -> np.ndarray:
        arm = named_arm(problem, fitted, laws, diagnoses)
        return held.scores(held.errors(laws if arm is None else arm.laws), floors)

    def less(joint: int, effect: str) -> tuple[float, Rejected | None, dict[int, JointDiagnosis]]:
        had, limits = out[joint], out[joint].case.limits
        tried = Rejected(effect, NO_GAIN, 0.0, limits.gain)
        fewer = _refitted(problem, fitted, laws, out | {joint: _without(had, (tried,))})
        gain = beyond_scatter(scores(fewer), scores(out))
        if (rejected := gains_too_little(effect, gain, limits)) is None:
            return gain[0], None, out
        law = had.law if rejected.rule == NOT_SIGNIFICANT else fewer[joint].law  # what gains stays in the correction
        return gain[0], rejected, fewer | {joint: replace(fewer[joint], law=law, rejected=(*had.rejected, rejected))}

    while len(names := [(j, c.effect) for j, d in out.items() for c in d.comparisons]) > 1:
        if not any(servo_effect(effect).chosen for _, effect in names):
            break
        failed = [test for test in (less(*name) for name in names) if test[1] is not None]
        if not failed:
            break
        out = min(failed, key=lambda test: test[0])[2]
    return out


def _without(found: JointDiagnosis, rejected: tuple[Rejected, ...]) -> JointDiagnosis:
    """The diagnosis without some of its named effects, the others fitted again; the complete law stays."""
    named = found.named
    for r in rejected:
        named = without(found.case, named, r.effect, named.fitted.scale)
    kept = tuple(c for c in found.comparisons if c.effect in named.effects)
    law = named.law if np.array_equal(found.law, found.named_law) else found.law
    return replace(found, named=named, comparisons=kept, rejected=(*found.rejected, *rejected), law=law)


def _with_law(found: JointDiagnosis, law: np.ndarray) -> JointDiagnosis:
    """A diagnosis with another named law; the complete law with it where it is the same."""
    named = replace(found.named, fitted=replace(found.named.fitted, law=law))
    complete = law if np.array_equal(found.law, found.named_law) else found.law
    return replace(found, named=named, law=complete)
