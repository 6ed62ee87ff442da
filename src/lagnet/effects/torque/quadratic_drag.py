"""Quadratic drag: torque proportional to the square of joint speed."""

from typing import final

import numpy as np

from lagnet.effects.effect import LinearEffect, Parameter
from lagnet.effects.excitation import needs_motion
from lagnet.effects.motion import Motion


@final
class QuadraticDrag(LinearEffect):
    """Air or churned oil resists with the square of speed: r = Fd v |v|."""

    name = "quadratic_drag"
    title = "Quadratic drag"
    formula = "Fd v |v|"
    parameters = (Parameter("Fd", "F_d", "N m s²/rad²", "torque per squared joint speed", lower=0.0),)
    plain_terms = 1
    shown_by = "high speed as well as low"
    confused_with = ("viscous_friction",)
    is_friction = True
    function_of_speed = True
    source = "armstrong1994"

    def regressor(self, motion: Motion, joint: int) -> np.ndarray:
        v = motion.v[:, [joint]]
        return v * np.abs(v)

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_motion(motion, joint)
