"""Whether a column lacks the sign that a torque must have."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.effort_column.finding import EffortLimits
from lagnet.diagnosis.effort_column.hypotheses import HypothesisFits
from lagnet.diagnosis.effort_column.regressions import columns_of
from lagnet.diagnosis.effort_column.samples import FAST, EffortSamples


def lacks_sign(fits: HypothesisFits, limits: EffortLimits) -> tuple[bool, str]:
    """Whether no number is negative although a joint's torque must have turned round.

    It must where the joint moves both ways and gravity does not hold it to one side: friction and inertia turn.

    Returns:
        Whether it lacks its sign, and what is told of it: nothing where some numbers are negative.
    """
    samples = fits.samples
    if (samples.y[:, fits.alive] < 0).any():
        return False, ""
    turning = [samples.joints[j] for j in fits.alive if _must_turn(samples, j, limits)]
    if turning:
        return True, f"no number is negative, though the torque must turn round at {', '.join(turning[:4])}"
    return False, "no number is negative, as gravity may have it"


def _must_turn(samples: EffortSamples, joint: int, limits: EffortLimits) -> bool:
    gravity, v = columns_of(samples, joint)["gravity"], samples.v[:, joint]
    fast = np.abs(v) > 0.2 * np.percentile(np.abs(v), FAST)
    both_ways = min(np.mean(v[fast] < 0), np.mean(v[fast] > 0)) > limits.turning if fast.any() else False
    held = gravity.any() and min(np.mean(gravity < 0), np.mean(gravity > 0)) < limits.turning
    return bool(both_ways and not held)
