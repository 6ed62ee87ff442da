"""Diagnosis of one joint: nominal law, named effects against rivals, 95 % intervals, the complete law."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.motion.joint.cases import LONG, windows_to_fit, with_long_windows
from lagnet.diagnosis.motion.joint.complete_law import complete_law, refit_to
from lagnet.diagnosis.motion.joint.fitting import free_coordinates, robust_scale
from lagnet.diagnosis.motion.joint.intervals import law_intervals
from lagnet.diagnosis.motion.joint.joint_case import JointCase, sizes_of
from lagnet.diagnosis.motion.joint.refitting import Selection, groups_of, refit
from lagnet.diagnosis.motion.joint.rest import RestBand, rest_band
from lagnet.diagnosis.motion.joint.rivals import Comparison, compare_rivals
from lagnet.diagnosis.motion.joint.selection import Rejected, select
from lagnet.diagnosis.motion.problem import MotionProblem


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
    data = replace(case.fit, windows=windows_to_fit(problem, fitted, joint))
    named = refit_to(case, chosen, data)
    scale = robust_scale(named.fitted.residual, case.floor)
    coordinates = free_coordinates(groups_of(case, named.effects), named.law, sizes_of(case.scales))
    intervals = law_intervals(data, named.law, coordinates, scale, case.floor)
    rest = rest_band(problem.series[joint], 2.0 * case.floor)
    long = with_long_windows(case, problem, fitted, joint)
    data = replace(case.fit, windows=windows_to_fit(problem, fitted, joint, LONG))
    law = complete_law(long, chosen, named, data)
    return JointDiagnosis(case, nominal, named, comparisons, rejected, intervals, law, rest)
