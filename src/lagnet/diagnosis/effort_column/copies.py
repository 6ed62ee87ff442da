"""Columns that are no effort: a copy of the position or velocity, or the position error times a gain."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lagnet.diagnosis.effort_column.finding import CANNOT_TELL, EffortLimits
from lagnet.diagnosis.effort_column.hypotheses import ERROR, HypothesisFits

ONE_GAIN = 0.1  # spread of the gains of joints over their mean, below which they are one gain
BETTER = 2.0  # times what one hypothesis leaves unexplained, which the other must leave at least
DEGREES = 57.29578  # in one radian
SAME_UNIT = 0.02  # of a factor: what is nearer to a unit has it


def copy_of(fits: HypothesisFits, kind: str, limits: EffortLimits) -> tuple[str, str] | None:
    """Unit of a column that is a copy of "position" or "velocity", and what is told of it; None where it is none."""
    factors = fits.gains(kind)
    predicted = min(fits.of(j, kind).explained for j in fits.alive) > limits.copy
    if not (predicted and _one_factor(factors)):
        return None
    unit = "degrees" if abs(np.median(factors) / DEGREES - 1) < SAME_UNIT else ""
    return unit, f"the column is the {kind} times {np.median(factors or [0.0]):.4g}"


def error_times_gain(fits: HypothesisFits, limits: EffortLimits) -> tuple[str, str] | None:
    """The output of a proportional controller, where that predicts more than the model's torque.

    Returns:
        Kind of column and what is told of it; None where the position error does not predict the column.
    """
    left, by_model = 1.0 - fits.mean(ERROR), 1.0 - fits.mean("torque")
    if fits.mean(ERROR) < limits.error or left > BETTER * by_model:
        return None
    gains = fits.gains(ERROR)
    listed = ", ".join(f"{gain:.4g}" for gain in gains[:7])
    share = f"{fits.mean(ERROR):.1%} of it is the position error times {listed}"
    better = left * BETTER < by_model
    alike = float(np.ptp(gains)) < ONE_GAIN * float(np.mean(np.abs(gains)))
    if alike and (better or len(gains) > 1):
        return ERROR, share
    if len(gains) > 1 and not better:
        return None  # a gain of its own at every joint, and no better than the model: a motor's effort
    # Under a purely proportional controller the motors' effort is the error times a gain of every joint.
    return CANNOT_TELL, f"{share}: the controller's output, or the motors' effort that follows it"


def _one_factor(factors: Sequence[float]) -> bool:
    """Whether all joints are copied alike; of a single joint, whether in a known unit: a spring or viscous friction is
    proportional to position or speed as well.
    """
    if len(factors) > 1:
        return float(np.ptp(factors)) < SAME_UNIT * float(np.mean(np.abs(factors)))
    return any(abs(f / unit - 1) < SAME_UNIT for f in factors for unit in (1.0, DEGREES))
