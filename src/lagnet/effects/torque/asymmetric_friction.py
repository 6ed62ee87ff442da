"""Asymmetric friction: dry friction that differs between the two directions."""

from typing import final

import numpy as np

from lagnet.effects.effect import LinearEffect, Parameter
from lagnet.effects.excitation import needs_both_directions
from lagnet.effects.motion import Motion


@final
class AsymmetricFriction(LinearEffect):
    """Gears worn or preloaded on one side resist more one way than the other: r = Fc⁺ for v > 0, −Fc⁻ for v < 0."""

    name = "asymmetric_friction"
    title = "Asymmetric friction"
    formula = "Fc⁺ s(v) for v > 0, Fc⁻ s(v) for v < 0"
    parameters = (
        Parameter("Fc_plus", "F_c^+", "N m", "torque against motion in the positive direction", lower=0.0),
        Parameter("Fc_minus", "F_c^-", "N m", "torque against motion in the negative direction", lower=0.0),
    )
    shown_by = "motion in both directions"
    confused_with = ("coulomb_friction", "torque_offset")
    contains = ("coulomb_friction",)
    sum_of = ("coulomb_friction", "torque_offset")
    absent = (("Fc_plus", 0.0), ("Fc_minus", 0.0))
    is_friction = True
    is_dry_friction = True
    function_of_speed = True
    source = "swevers2007"

    def regressor(self, motion: Motion, joint: int) -> np.ndarray:
        direction = motion.direction(joint)
        return np.column_stack([np.maximum(direction, 0.0), np.minimum(direction, 0.0)])

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_both_directions(motion, joint)
