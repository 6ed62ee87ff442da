"""How many of a column's units are one N m of the model's torque, joint by joint."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.effort_column.finding import EffortLimits
from lagnet.diagnosis.effort_column.hypotheses import HypothesisFits

ROTOR = 0.05  # of the link's inertia: a rotor that cannot be told from the only body behind it


def joint_factors(fits: HypothesisFits, with_gravity: bool, limits: EffortLimits) -> dict[int, tuple[float, float]]:
    """Column units per N m with their standard deviation, of each joint whose factor is significant.

    Args:
        with_gravity: gravity is in the column, so that its factor counts beside that of inertia.
    """
    found = {j: _factor(fits, j, with_gravity, limits) for j in fits.alive}
    return {j: factor for j, factor in found.items() if factor is not None}


def joint_loads(fits: HypothesisFits, joints: list[int]) -> list[float]:
    """Root mean square of the nominal torque of each joint [N m]."""
    nominal = fits.samples.gravity + fits.samples.dynamic
    return [float(np.sqrt(np.mean(nominal[:, j] ** 2))) for j in joints]


def _factor(fits: HypothesisFits, joint: int, with_gravity: bool, limits: EffortLimits) -> tuple[float, float] | None:
    """Column units per N m at a joint: by gravity where that is in it, else by inertia."""
    found, choices = fits.of(joint, "torque"), []
    for term in ("gravity", "dynamic") if with_gravity else ("dynamic",):
        value, sigma = found.of(term)
        if abs(value) <= limits.significant * sigma:
            continue
        if term == "dynamic" and "rotor" not in found.terms:
            sigma = float(np.hypot(sigma, ROTOR * abs(value)))
        choices.append((abs(value) / max(sigma, 1e-12), value, sigma))
    return max(choices)[1:] if choices else None
