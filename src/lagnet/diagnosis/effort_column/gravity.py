"""Whether gravity is in a column of effort."""

from __future__ import annotations

from lagnet.diagnosis.effort_column.finding import EffortLimits
from lagnet.diagnosis.effort_column.hypotheses import HypothesisFits

PER_JOINT = 5.0  # times the gain that gravity needs, which it must add for each joint that has the motion without it


def holds_gravity(fits: HypothesisFits, limits: EffortLimits) -> tuple[bool | None, str]:
    """Whether gravity is in the column, None where that cannot be told, and what is told of it."""
    gains, without = _joints_by_gravity(fits, limits)
    if not gains and not without:
        if not any("gravity" in fits.of(j, "torque").terms for j in fits.alive):
            return True, "gravity does not load these joints"
        return None, "neither gravity nor the rest of the model's torque stands out of the column"
    if gains and without and sum(gains.values()) < PER_JOINT * limits.gain * len(without):
        return None, "gravity is in the column of some joints and not of others"
    joints = fits.samples.joints
    if gains:
        told = (
            f"gravity is in it: without it {fits.mean('torque without gravity'):.0%} is predicted in place of"
            f" {fits.mean('torque'):.0%} (most at {joints[max(gains, key=lambda j: gains[j])]})"
        )
        return True, told
    listed = ", ".join(joints[j] for j in without[:4])
    return False, f"gravity is not in it: its factor is below a quarter of the inertia's at {listed}"


def _joints_by_gravity(fits: HypothesisFits, limits: EffortLimits) -> tuple[dict[int, float], list[int]]:
    """Joints whose column holds gravity, each with the share of variance that it adds, and joints whose does not."""
    gains: dict[int, float] = {}
    without: list[int] = []
    for j in fits.alive:
        found = fits.of(j, "torque")
        (g, sg), (d, sd) = found.of("gravity"), found.of("dynamic")
        if "gravity" not in found.terms:
            continue
        left = 1.0 - fits.of(j, "torque without gravity").explained
        gain = found.explained - (1.0 - left)
        stands_out = gain > limits.gain or gain > limits.gain_of_rest * left
        if abs(g) > limits.significant * sg and stands_out:
            gains[j] = gain
        elif abs(d) > limits.significant * sd and abs(g) + 2 * sg < limits.without_gravity * abs(d):
            without.append(j)
    return gains, without
