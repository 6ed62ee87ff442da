"""Torque offset: a constant that the sensor adds."""

from typing import final

import numpy as np

from lagnet.effects.effect import LinearEffect, Parameter
from lagnet.effects.excitation import needs_both_directions
from lagnet.effects.motion import Motion


@final
class TorqueOffset(LinearEffect):
    """A sensor or current amplifier that is not zeroed adds a constant: r = b."""

    name = "torque_offset"
    title = "Torque offset"
    formula = "b"
    parameters = (Parameter("b", "b", "N m", "constant added to the recorded torque"),)
    stage = "signal"
    shown_by = "motion in both directions, in many poses"
    confused_with = ("asymmetric_friction", "gravity_tilt", "joint_spring")
    function_of_speed = True
    source = "swevers2007"

    def regressor(self, motion: Motion, joint: int) -> np.ndarray:
        return np.ones((motion.time.size, 1))

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_both_directions(motion, joint)
