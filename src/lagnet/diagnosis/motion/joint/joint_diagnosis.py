"""Diagnosis of one joint: nominal law, named effects against rivals, 95 % intervals, the complete law."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.motion.joint.block_scores import advantage
from lagnet.diagnosis.motion.joint.cases import LONG, windows_to_fit, with_long_windows
from lagnet.diagnosis.motion.joint.fitting import JointData, fit_law, free_coordinates, robust_scale
from lagnet.diagnosis.motion.joint.intervals import law_intervals
from lagnet.diagnosis.motion.joint.joint_case import JointCase, sizes_of
from lagnet.diagnosis.motion.joint.refitting import Selection, groups_of, refit, starts_with
from lagnet.diagnosis.motion.joint.rest import RestBand, rest_band
from lagnet.diagnosis.motion.joint.rivals import Comparison, compare_rivals
from lagnet.diagnosis.motion.joint.selection import Rejected, select, unless_unexplained
from lagnet.diagnosis.motion.problem import MotionProblem
from lagnet.servos.catalogue import servo_effect

IDENTIFIED = (
    "gain_error",
    "viscous_friction",
    "coulomb_friction",
    "load_dependent_friction",
    "position_bias",
    "command_delay",
    "rotor_inertia",
    "quadratic_drag",
    "stribeck_friction",
)  # effects of the complete law, named or not
FURTHER = (
    "duty_saturation",
    "gear_friction",
    "directional_load_friction",
    "quadratic_load_friction",
    "static_friction",
    "dead_band",
)


@dataclass(frozen=True, eq=False)
class JointDiagnosis:
    """The findings at one joint.

    Args:
        case: data, nominal law and limits.
        nominal: the nominal law, fitted where no servo was given.
        named: effects with evidence.
        comparisons: of each named effect with its rivals.
        rejected: effects that were considered and not named.
        intervals: 95 % interval of every free law parameter of the named effects.
        law: the complete correction, named or not.
        rest: the friction band of positions at standstill, None where the joint seldom stands still.
    """

    case: JointCase
    nominal: np.ndarray
    named: Selection
    comparisons: tuple[Comparison, ...]
    rejected: tuple[Rejected, ...]
    intervals: dict[str, tuple[float, float]]
    law: np.ndarray
    rest: RestBand | None

    @property
    def named_law(self) -> np.ndarray:
        """The nominal law with the named effects, shape (len(LAW),)."""
        return self.named.law


def diagnose_joint(problem: MotionProblem, fitted: int, joint: int, case: JointCase) -> JointDiagnosis:
    """Selects, compares and refits the effects of one joint.

    Args:
        problem: all recordings, of which the first `fitted` may be fitted.
        fitted: number of them.
        joint: its index.
        case: its data.
    """
    nominal = case.law
    if case.base:
        nominal = refit(case, (), case.law, robust_scale(case.fit.errors(case.law), case.floor)).law
    case = replace(case, law=nominal)
    chosen, rejected = select(case)
    chosen, comparisons = compare_rivals(case, chosen)
    kept, dropped = unless_unexplained(case, chosen)
    if dropped:
        chosen, comparisons, rejected = kept, (), (*rejected, *dropped)
    data = replace(case.fit, windows=windows_to_fit(problem, fitted, joint))
    named = _refitted(case, chosen, data)
    scale = robust_scale(named.fitted.residual, case.floor)
    coordinates = free_coordinates(groups_of(case, named.effects), named.law, sizes_of(case.scales))
    intervals = law_intervals(data, named.law, coordinates, scale, case.floor)
    rest = rest_band(problem.series[joint], 2.0 * case.floor)
    long = with_long_windows(case, problem, fitted, joint)
    data = replace(case.fit, windows=windows_to_fit(problem, fitted, joint, LONG))
    law = _complete(long, chosen, named, data)
    return JointDiagnosis(case, nominal, named, comparisons, rejected, intervals, law, rest)


def _refitted(case: JointCase, chosen: Selection, data: JointData) -> Selection:
    """The chosen effects fitted to every window of the fitted recordings."""
    scale = robust_scale(data.errors(chosen.law), case.floor)
    coordinates = free_coordinates(groups_of(case, chosen.effects), chosen.law, sizes_of(case.scales))
    fitted = fit_law(data, chosen.law, coordinates, scale=scale, iterations=40, patient=True)
    return replace(chosen, fitted=fitted)


def _complete(case: JointCase, chosen: Selection, named: Selection, data: JointData) -> np.ndarray:
    """The law with all plain effects beside the named ones, where its validation score is better: for prediction."""
    contained = {c for e in chosen.effects for c in servo_effect(e).contains}
    more = [e for e in IDENTIFIED if e in case.excited and e not in {*chosen.effects, *contained}]
    more = [e for e in more if case.scale_is_set or e != "gain_error"]
    if "stribeck_friction" in more:
        more = [e for e in more if e != "coulomb_friction"]
    scale = robust_scale(chosen.fitted.residual, case.floor)
    chosen = refit(case, chosen.effects, chosen.law, scale)
    best = _best_of(case, chosen.law, (*chosen.effects, *more), scale)
    for extra in FURTHER:
        if extra in case.excited and extra not in best.effects:
            kept = tuple(e for e in best.effects if e not in servo_effect(extra).contains)
            starts = starts_with(case, best, extra)
            tries = [
                refit(case, (*kept, extra), start, robust_scale(best.fitted.residual, case.floor)) for start in starts
            ]
            better = min(tries, key=lambda s: s.blocks.mean())
            gain, errors = advantage(best.blocks, better.blocks)
            if gain > case.limits.gain and errors > case.limits.tie:
                best = better
    if advantage(chosen.blocks, best.blocks)[0] <= 0.0:
        return named.law
    return _refitted(case, best, data).law


def _best_of(case: JointCase, law: np.ndarray, effects: tuple[str, ...], scale: float) -> Selection:
    """The better fit of two starts: the named law, with and without the plain effects of the equation error."""
    starts = [_with_stribeck_speed(start, case, effects) for start in (law, _merged(law, case))]
    return min((refit(case, effects, start, scale) for start in starts), key=lambda s: s.blocks.mean())


def _with_stribeck_speed(law: np.ndarray, case: JointCase, effects: tuple[str, ...]) -> np.ndarray:
    """The law with vs > 0 where it is free: at vs = 0 its derivative is zero."""
    out = law.copy()
    if "stribeck_friction" in effects:
        shape = servo_effect("stribeck_friction")
        values = shape.read(out)
        if values["vs"] == 0.0:
            out = shape.apply(out, values | {"vs": 0.3 * case.scales.speed})
    return out


def _merged(law: np.ndarray, case: JointCase) -> np.ndarray:
    """The law with the plain effects of the equation error where it is nominal."""
    return np.where(law == case.law, case.start, law) if case.scale_is_set else law
