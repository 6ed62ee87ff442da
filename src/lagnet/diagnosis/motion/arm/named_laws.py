"""The laws of the named effects fitted to rollouts of the whole arm, and their intervals.

Selection rolls out one joint while the others move as measured, whose accelerations are smoothed: that is fast, and
biases values by a percent or two. Here all joints are coupled and every load is the model's own. A parameter moves its
own joint first of all, so that in a fit one rollout gives the sensitivity of one parameter of every joint at once;
intervals take each by itself.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.motion.arm.fitting import DIFFERENCE, fit_values
from lagnet.diagnosis.motion.arm.profiles import profiled_ends
from lagnet.diagnosis.motion.arm.rollouts import ArmRuns, runs_held_out, runs_to_fit
from lagnet.diagnosis.motion.arm.secants import settled_secants
from lagnet.diagnosis.motion.joint.block_scores import advantage
from lagnet.diagnosis.motion.joint.constancy import CHANGES_WITHIN, trends_of
from lagnet.diagnosis.motion.joint.fitting import Coordinates, free_coordinates
from lagnet.diagnosis.motion.joint.joint_case import sizes_of
from lagnet.diagnosis.motion.joint.joint_diagnosis import JointDiagnosis
from lagnet.diagnosis.motion.joint.refitting import groups_of, without
from lagnet.diagnosis.motion.joint.selection import (
    NEAR_NOMINAL,
    NO_GAIN,
    REMAINDER,
    WITHIN_INTERVAL,
    Rejected,
    refuted_by_load,
    relative_change,
)
from lagnet.diagnosis.motion.problem import MotionProblem
from lagnet.servos.catalogue import servo_effect
from lagnet.servos.parameters import INDEX

ITERATIONS = 6  # in each round: a fit joint by joint is near


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
    while nominal := {j: near for j, d in out.items() if (near := (*_near_nominal(d), *_refuted(d)))}:
        out = {j: _without(d, nominal.get(j, ())) for j, d in out.items()}
        out = _refitted(problem, fitted, laws, out)
    out = _needed_beside_yielding(problem, fitted, laws, out)
    if left := _unexplained(problem, fitted, laws, out):
        out = _refitted(problem, fitted, laws, {j: _without(d, left.get(j, ())) for j, d in out.items()})
    if passing := {j: left for j, d in out.items() if (left := _passing(problem, fitted, j, d))}:
        out = {j: replace(_without(d, passing[j]), law=d.law) if j in passing else d for j, d in out.items()}
        out = _refitted(problem, fitted, laws, out)
    out = _with_intervals(problem, fitted, laws, out)
    if not (open_ := {j: left for j, d in out.items() if (left := _undetermined(d))}):
        return out
    out = {j: replace(_without(d, open_[j]), law=d.law) if j in open_ else d for j, d in out.items()}  # names alone go
    return _with_intervals(problem, fitted, laws, out, open_)  # those of other joints, with more free, are no narrower


def with_named_laws(laws: np.ndarray, found: Mapping[int, JointDiagnosis]) -> np.ndarray:
    """The laws of all joints, those that were diagnosed with their named ones, shape (dof, len(LAW))."""
    out = laws.copy()
    for joint, d in found.items():
        out[joint] = d.named_law
    return out


def _arm_of(
    problem: MotionProblem, fitted: int, laws: np.ndarray, found: Mapping[int, JointDiagnosis]
) -> ArmLaws | None:
    """The named laws with what is free in them, None where nothing is."""
    laws, free = with_named_laws(laws, found), {}
    for joint, diagnosis in found.items():
        if groups := groups_of(diagnosis.case, diagnosis.named.effects):
            free[joint] = free_coordinates(groups, laws[joint], sizes_of(diagnosis.case.scales))
    return ArmLaws(ArmRuns(problem, runs_to_fit(problem, fitted), tuple(found)), laws, free) if free else None


def _floors(found: Mapping[int, JointDiagnosis]) -> np.ndarray:
    return np.array([d.case.floor for d in found.values()])


def _refitted(
    problem: MotionProblem, fitted: int, laws: np.ndarray, found: Mapping[int, JointDiagnosis]
) -> dict[int, JointDiagnosis]:
    """The named laws fitted to the whole arm, unless held-out motion is predicted worse by them."""
    arm, floors = _arm_of(problem, fitted, laws, found), _floors(found)
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
    arm = _arm_of(problem, fitted, laws, found)
    free = {} if arm is None else {j: c for j, c in arm.free.items() if joints is None or j in joints}
    if arm is None or not free:
        return dict(found)
    arm = replace(arm, free=free)
    values = arm.read()
    here, floors = arm.errors(values), _floors(found)
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
    link's they lack what the link does, and take it for a cause of their own.
    """
    out = dict(found)
    names = sorted((c.gain, j, c.effect) for j, d in out.items() for c in d.comparisons)
    if len(names) < 2 or not any(servo_effect(effect).chosen for _, _, effect in names):
        return out
    held, floors = ArmRuns(problem, runs_held_out(problem, fitted), tuple(out)), _floors(out)

    def scores(diagnoses: Mapping[int, JointDiagnosis]) -> np.ndarray:
        arm = _arm_of(problem, fitted, laws, diagnoses)
        return held.scores(held.errors(laws if arm is None else arm.laws), floors)

    for _, joint, effect in names[:-1]:
        rejected = Rejected(effect, NO_GAIN, 0.0, out[joint].case.limits.gain)
        fewer = _refitted(problem, fitted, laws, out | {joint: _without(out[joint], (rejected,))})
        gain = advantage(scores(fewer), scores(out))[0]
        if gain < out[joint].case.limits.gain:
            kept = replace(fewer[joint], rejected=(*out[joint].rejected, replace(rejected, value=gain)))
            out = fewer | {joint: kept}
    return out


def _unexplained(
    problem: MotionProblem, fitted: int, laws: np.ndarray, found: Mapping[int, JointDiagnosis]
) -> dict[int, tuple[Rejected, ...]]:
    """Names of joints at which all names together leave most of the error of given servos: then the cause is another.

    The errors are those of held-out recordings, rolled out whole with all joints coupled.
    """
    held, nominal = ArmRuns(problem, runs_held_out(problem, fitted), tuple(found)), laws.copy()
    for joint, d in found.items():
        nominal[joint] = d.case.law
    named = with_named_laws(laws, found)
    before, after = ([float(np.sqrt(np.mean(e**2))) for e in held.errors(x)] for x in (nominal, named))
    out = {}
    for (joint, d), was, is_ in zip(found.items(), before, after, strict=True):
        limits = d.case.limits
        limit = max(limits.remainder * was, limits.unexplained * d.case.floor)
        if not d.case.base and d.named.effects and is_ > limit:
            out[joint] = tuple(Rejected(e, REMAINDER, is_, limit) for e in d.named.effects)
    return out


def _near_nominal(found: JointDiagnosis) -> tuple[Rejected, ...]:
    """Effects of a given servo whose values are the nominal ones but for a few percent."""
    if found.case.base:
        return ()
    limit = found.case.limits.change
    changes = {e: relative_change(found.case.law, found.named_law, e) for e in found.named.effects}
    return tuple(Rejected(e, NEAR_NOMINAL, change, limit) for e, change in changes.items() if change < limit)


def _refuted(found: JointDiagnosis) -> tuple[Rejected, ...]:
    """Effects with which the load could never have moved the joint, although it did."""
    tests = (refuted_by_load(found.case, found.named_law, e) for e in found.named.effects)
    return tuple(rejected for rejected in tests if rejected is not None)


def _undetermined(found: JointDiagnosis) -> tuple[Rejected, ...]:
    """Effects of a given servo none of whose 95 % intervals leaves out the nominal value: their size is not known.

    A joint by itself may prefer such an effect; beside the other joints its size is open, or stands at a bound.
    """
    if found.case.base:
        return ()
    sizes = {e: _half_widths_away(found, e) for e in found.named.effects}
    return tuple(Rejected(e, WITHIN_INTERVAL, size, 1.0) for e, size in sizes.items() if size <= 1.0)


def _passing(problem: MotionProblem, fitted: int, joint: int, found: JointDiagnosis) -> tuple[Rejected, ...]:
    """Effects of a given servo that grow or fade through every recording by more than a share of what they change."""
    if found.case.base or not found.named.effects:
        return ()
    limit = found.case.limits.trend
    trends = trends_of(problem, fitted, joint, found.case, found.named_law, found.named.effects)
    return tuple(Rejected(e, CHANGES_WITHIN, t.least, limit) for e, t in trends.items() if t.least > limit)


def _half_widths_away(found: JointDiagnosis, effect: str) -> float:
    """max |p − p₀| over the width of p's interval towards p₀, of all parameters of an effect; infinite without one."""
    away = [away_from_nominal(found, g[0]) for g in groups_of(found.case, (effect,))]
    return max(away, default=np.inf)


def away_from_nominal(found: JointDiagnosis, name: str) -> float:
    """|p − p₀| of a law parameter over the width of its interval towards p₀, infinite where it has none."""
    value, nominal = float(found.named_law[INDEX[name]]), float(found.case.law[INDEX[name]])
    low, high = found.intervals.get(name, (np.nan, np.nan))
    size = abs(value - nominal) / max(value - low if nominal < value else high - value, 1e-12)
    return size if np.isfinite(size) else np.inf


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
