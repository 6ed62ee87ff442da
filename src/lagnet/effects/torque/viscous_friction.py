"""Viscous friction: torque proportional to joint speed."""

from typing import final

import numpy as np

from lagnet.effects.effect import LinearEffect, Parameter
from lagnet.effects.excitation import needs_motion
from lagnet.effects.motion import Motion


@final
class ViscousFriction(LinearEffect):
    """Lubricant sheared between moving parts resists in proportion to speed: r = Fv v."""

    name = "viscous_friction"
    title = "Viscous friction"
    formula = "Fv v"
    parameters = (Parameter("Fv", "F_v", "N m s/rad", "torque per joint speed", lower=0.0),)
    shown_by = "a range of speeds, slow and fast"
    confused_with = ("time_delay", "quadratic_drag")
    is_friction = True
    function_of_speed = True
    source = "swevers2007"

    def regressor(self, motion: Motion, joint: int) -> np.ndarray:
        return motion.v[:, [joint]]

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_motion(motion, joint)
