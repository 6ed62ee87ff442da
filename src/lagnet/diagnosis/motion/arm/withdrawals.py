"""Rules that withdraw a name once the whole arm is rolled out; what a name explains stays in the correction."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from lagnet.diagnosis.motion.arm.arm_laws import with_named_laws
from lagnet.diagnosis.motion.arm.constancy import CHANGES_WITHIN, trends_of
from lagnet.diagnosis.motion.arm.rollouts import PIECE, ArmRuns, runs_held_out, runs_to_fit
from lagnet.diagnosis.motion.joint.joint_diagnosis import JointDiagnosis
from lagnet.diagnosis.motion.joint.refitting import groups_of
from lagnet.diagnosis.motion.joint.selection import (
    NEAR_NOMINAL,
    REMAINDER,
    WITHIN_INTERVAL,
    Rejected,
    refuted_by_load,
    relative_change,
)
from lagnet.diagnosis.motion.problem import MotionProblem
from lagnet.servos.parameters import INDEX


def unexplained(
    problem: MotionProblem, fitted: int, laws: np.ndarray, found: Mapping[int, JointDiagnosis]
) -> dict[int, tuple[Rejected, ...]]:
    """Names of joints at which all names together leave most of the error of given servos: then the cause is another.

    The errors are those of all recordings, fitted or not, rolled out with all joints coupled, but for the piece
    of time in which names leave most: a joint that sticks once where its rollout slips says little of the rest.
    """
    runs, nominal = (*runs_to_fit(problem, fitted), *runs_held_out(problem, fitted)), laws.copy()
    for joint, d in found.items():
        nominal[joint] = d.case.law
    whole = ArmRuns(problem, runs, tuple(found))
    named = with_named_laws(laws, found)
    before, after = whole.errors(nominal), whole.errors(named)
    out = {}
    for (joint, d), was, is_ in zip(found.items(), before, after, strict=True):
        kept = _but_for_one_piece(whole, is_)
        limits, (was, is_) = d.case.limits, (float(np.sqrt(np.mean(e[kept] ** 2))) for e in (was, is_))
        limit = max(limits.remainder * was, limits.unexplained * d.case.floor)
        if not d.case.base and d.named.effects and is_ > limit:
            out[joint] = tuple(Rejected(e, REMAINDER, is_, limit) for e in d.named.effects)
    return out


def _but_for_one_piece(data: ArmRuns, errors: np.ndarray) -> np.ndarray:
    """The samples outside of that piece of about `PIECE` seconds that holds most of Σ e²; all of a single piece."""
    edges = np.cumsum([0, *(run.last - run.first + 1 for run in data.runs)])
    pieces = [
        p
        for run, a, b in zip(data.runs, edges, edges[1:], strict=False)
        for p in np.array_split(np.arange(a, b), max(1, round(data.seconds(run) / PIECE)))
    ]
    worst = int(np.argmax([np.sum(errors[p] ** 2) for p in pieces]))
    return np.concatenate([p for i, p in enumerate(pieces) if i != worst or len(pieces) == 1])


def near_nominal(found: JointDiagnosis) -> tuple[Rejected, ...]:
    """Effects of a given servo whose values are the nominal ones but for a few percent."""
    if found.case.base:
        return ()
    limit = found.case.limits.change
    changes = {e: relative_change(found.case.law, found.named_law, e) for e in found.named.effects}
    return tuple(Rejected(e, NEAR_NOMINAL, change, limit) for e, change in changes.items() if change < limit)


def refuted(found: JointDiagnosis) -> tuple[Rejected, ...]:
    """Effects with which the load could never have moved the joint, although it did."""
    tests = (refuted_by_load(found.case, found.named_law, e) for e in found.named.effects)
    return tuple(rejected for rejected in tests if rejected is not None)


def undetermined(found: JointDiagnosis) -> tuple[Rejected, ...]:
    """Effects of a given servo none of whose 95 % intervals leaves out the nominal value: their size is not known.

    A joint by itself may prefer such an effect; beside the other joints its size is open, or stands at a bound.
    """
    if found.case.base:
        return ()
    sizes = {e: _half_widths_away(found, e) for e in found.named.effects}
    return tuple(Rejected(e, WITHIN_INTERVAL, size, 1.0) for e, size in sizes.items() if size <= 1.0)


def passing(problem: MotionProblem, fitted: int, joint: int, found: JointDiagnosis) -> tuple[Rejected, ...]:
    """Effects of a given servo that grow or fade through every recording by more than a share of what they change.

    That share, and that there is any change beyond scatter, are two questions: of a short recording a change by half is
    not known to a fifth.
    """
    if found.case.base or not found.named.effects:
        return ()
    limit = found.case.limits.trend
    trends = trends_of(problem, fitted, joint, found.case, found.named_law, found.named.effects)
    return tuple(Rejected(e, CHANGES_WITHIN, t.share, limit) for e, t in trends.items() if t.is_more_than(limit))


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
