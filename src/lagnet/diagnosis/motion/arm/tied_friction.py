"""Fc + K |load| + K₂ load² of a joint whose load hardly varies is one number: which part of the sum it is stays open.

The interval of a part holds while the other parts are the nominal ones. With another part free beside it, it is wider
by 1/√(1 − ρ²), ρ the correlation of both over the loads that occurred. A part whose interval then holds the nominal
value may as well be the other one: both are tied, and the interval is the wider one. Two more signs that a name is
one of several: the complete law of the joint, which predicts no worse, has the friction elsewhere; and a break-away
torque may be none at all, so that it is the dry friction fitted beside it that was asked for.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.motion.arm.arm_laws import ArmLaws, with_named_laws
from lagnet.diagnosis.motion.arm.intervals import half_widths
from lagnet.diagnosis.motion.arm.rollouts import ArmRuns, runs_to_fit
from lagnet.diagnosis.motion.arm.secants import settled_secants
from lagnet.diagnosis.motion.arm.withdrawals import away_from_nominal
from lagnet.diagnosis.motion.joint.fitting import free_coordinates
from lagnet.diagnosis.motion.joint.joint_case import sizes_of
from lagnet.diagnosis.motion.joint.joint_diagnosis import JointDiagnosis
from lagnet.diagnosis.motion.joint.refitting import groups_of
from lagnet.diagnosis.motion.joint.rivals import Comparison
from lagnet.diagnosis.motion.problem import MotionProblem
from lagnet.servos.catalogue import SERVO_CATALOGUE, servo_effect
from lagnet.servos.parameters import INDEX, LAW

PARTS = ("coulomb_friction", "load_dependent_friction", "quadratic_load_friction")  # by |load|⁰, |load|¹, |load|²
CONTRADICTED = 3.0  # widths of its interval by which the complete law has another value
ELSEWHERE = 0.5  # share of a named change of a parameter, less of which the complete law has
OPEN = 0.1  # squared share of a parameter in a direction that no joint shows, from which on it is not known


def tie_dry_friction(
    problem: MotionProblem, fitted: int, laws: np.ndarray, found: Mapping[int, JointDiagnosis]
) -> dict[int, JointDiagnosis]:
    """The diagnoses, with parts of dry friction that motion does not tell apart tied, and their intervals widened.

    Args:
        problem: all recordings, the first `fitted` of them fitted.
        fitted: number of them.
        laws: nominal, shape (dof, len(LAW)), for joints that do not move.
        found: diagnoses with intervals and complete laws.
    """
    laws, out = with_named_laws(laws, found), {}
    runs = ArmRuns(problem, runs_to_fit(problem, fitted), tuple(found))
    floors = np.array([d.case.floor for d in found.values()])
    for joint, d in found.items():
        for effect in d.named.effects:
            if effect in PARTS:
                d = _tied(d, effect, _widths(runs, laws, floors, joint, d, effect))
            else:
                d = _tied_to_what_is_beside(d, effect)
        out[joint] = d
    return out


def _rivals(found: JointDiagnosis, effect: str) -> tuple[str, ...]:
    """Parts by the next power of the load that the motion excites, and that no named effect has free."""
    free = {name for group in groups_of(found.case, found.named.effects) for name in group}
    near = [p for p in PARTS if abs(PARTS.index(p) - PARTS.index(effect)) == 1]
    return tuple(p for p in near if p in found.case.excited and not free & set(servo_effect(p).frees[0]))


def _widths(
    runs: ArmRuns, laws: np.ndarray, floors: np.ndarray, joint: int, found: JointDiagnosis, effect: str
) -> dict[str, tuple[float, float]]:
    """For each rival the factor by which it widens the interval of a part of dry friction at a joint, and its own size.

    That size, in units of the part, is by how much the part may grow until the rival is none.

    Slopes of both are differences by the same torque, that of the part's own interval: differences of two sizes meet
    other starts of a joint that sticks, and would tell apart by chance what is one.
    """
    groups, rivals = groups_of(found.case, found.named.effects), _rivals(found, effect)
    if not rivals or servo_effect(effect).frees[0] not in groups:
        return {}
    arm = ArmLaws(runs, laws, {joint: free_coordinates(groups, laws[joint], sizes_of(found.case.scales))})
    values = arm.read()
    here = arm.errors(values)
    secants = settled_secants(arm.errors, values, here, arm.sizes, floors, arm.nearest)
    own, load = groups.index(servo_effect(effect).frees[0]), found.case.fit.series.load
    torque = secants.half[own] * _per_unit(effect, load)
    columns = {
        part: _slope(runs, laws, here, joint, part, torque / _per_unit(part, load)) for part in (effect, *rivals)
    }
    for slope, column in zip(secants.slopes, columns[effect], strict=True):
        slope[:, own] = column
    (alone, *_), _ = half_widths(here, secants.slopes, floors, np.eye(len(groups))[[own]])
    out = {}
    for rival in rivals:
        slopes = [np.column_stack([s, c]) for s, c in zip(secants.slopes, columns[rival], strict=True)]
        (half, *_), unseen = half_widths(here, slopes, floors, np.eye(len(groups) + 1)[[own]])
        factor = np.inf if np.sum(unseen[own] ** 2) > OPEN else max(1.0, float(half / max(alone, 1e-300)))
        size = float(laws[joint, INDEX[servo_effect(rival).frees[0][0]]])
        out[rival] = factor, size * _per_unit(rival, load) / _per_unit(effect, load)
    return out


def _per_unit(part: str, load: np.ndarray) -> float:
    """Mean torque of a part of dry friction per unit of its parameter: 1, |load| or load²."""
    return float(np.mean(np.abs(load) ** PARTS.index(part)))


def _slope(
    runs: ArmRuns, laws: np.ndarray, here: list[np.ndarray], joint: int, part: str, step: float
) -> list[np.ndarray]:
    """(q̂(p + s) − q̂(p)) of every joint for a parameter of one joint that grows by s."""
    moved = laws.copy()
    moved[joint, [INDEX[n] for n in servo_effect(part).frees[0]]] += step
    return [m - e for m, e in zip(runs.errors(moved), here, strict=True)]


def _tied(found: JointDiagnosis, effect: str, widths: Mapping[str, tuple[float, float]]) -> JointDiagnosis:
    """The diagnosis with one part of dry friction tied to those that it cannot be told from."""
    names, intervals = servo_effect(effect).frees[0], dict(found.intervals)
    if not set(names) <= set(intervals):
        return found
    law = replace(found, intervals={n: _contradicting(found, n) for n in names})
    contradicted = any(law.intervals[n] != found.intervals[n] for n in names)
    tied = [r for r in PARTS if r != effect and contradicted and _more_in_complete(found, effect, r)]
    for rival, (factor, size) in widths.items():
        wider = {n: _widened(found, n, factor, size) for n in names}
        if rival in _comparison(found, effect).tied or _holds(replace(found, intervals=wider), names):
            tied.append(rival)
            law = replace(law, intervals={n: _hull(law.intervals[n], wider[n]) for n in names})
    return _with_ties(replace(found, intervals=intervals | law.intervals), effect, tied)


def _tied_to_what_is_beside(found: JointDiagnosis, effect: str) -> JointDiagnosis:
    """The diagnosis with an effect tied to one whose parameter it frees, where its own may as well be nominal."""
    law = servo_effect(effect)
    own = [g[0] for g in law.frees]
    if not law.with_it or not set(own) <= set(found.intervals) or not _holds(found, own):
        return found
    named = set(found.named.effects)
    beside = [n for n, e in SERVO_CATALOGUE.items() if n not in named and e.frees == tuple((p,) for p in law.with_it)]
    return _with_ties(found, effect, [n for n in beside if n in found.case.excited])


def _holds(found: JointDiagnosis, names: tuple[str, ...] | list[str]) -> bool:
    """Whether the intervals of all these law parameters hold their nominal values."""
    return all(away_from_nominal(found, n) <= 1.0 for n in names)


def _widened(found: JointDiagnosis, name: str, factor: float, size: float) -> tuple[float, float]:
    """The interval of a law parameter, so many times as wide, within bounds and as far as a rival of a size lets it."""
    value, (low, high) = float(found.named_law[INDEX[name]]), found.intervals[name]
    below, above = (factor * width if width > 0.0 else 0.0 for width in (value - low, high - value))
    return max(value - below, LAW[INDEX[name]].lower), min(value + above, high + size)


def _contradicting(found: JointDiagnosis, name: str) -> tuple[float, float]:
    """The interval of a law parameter, with the complete law's value in it where that is far outside."""
    value, other = (float(law[INDEX[name]]) for law in (found.named_law, found.law))
    low, high = found.intervals[name]
    width = value - low if other < value else high - value
    return _hull((low, high), (other, other)) if abs(other - value) > CONTRADICTED * width else (low, high)


def _more_in_complete(found: JointDiagnosis, effect: str, rival: str) -> bool:
    """Whether the complete law has a named part of dry friction elsewhere, in this rival."""
    name, other = (INDEX[servo_effect(e).frees[0][0]] for e in (effect, rival))
    named, complete, nominal = found.named_law, found.law, found.case.law
    less = abs(complete[name] - nominal[name]) < ELSEWHERE * abs(named[name] - nominal[name])
    return bool(less and complete[other] > named[other] and rival in found.case.excited)


def _hull(one: tuple[float, float], other: tuple[float, float]) -> tuple[float, float]:
    return min(one[0], other[0]), max(one[1], other[1])


def _comparison(found: JointDiagnosis, effect: str) -> Comparison:
    return next(c for c in found.comparisons if c.effect == effect)


def _with_ties(found: JointDiagnosis, effect: str, rivals: list[str]) -> JointDiagnosis:
    """The diagnosis with further rivals tied to an effect."""
    before = _comparison(found, effect)
    new = replace(before, tied=tuple(dict.fromkeys([*before.tied, *rivals])))
    return replace(found, comparisons=tuple(new if c is before else c for c in found.comparisons))
