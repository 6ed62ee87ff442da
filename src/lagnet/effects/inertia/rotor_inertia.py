"""Rotor inertia: the motor's own inertia, seen through the gear."""

from typing import final

import numpy as np

from lagnet.effects.effect import LinearEffect, Parameter
from lagnet.effects.excitation import needs_motion
from lagnet.effects.motion import Motion


@final
class RotorInertia(LinearEffect):
    """The rotor turns N times as fast as the joint and adds its inertia N² times: r = Ia a."""

    name = "rotor_inertia"
    title = "Rotor inertia"
    formula = "Ia a"
    parameters = (Parameter("Ia", "I_a", "kg m²", "inertia of rotor and gear about the joint", lower=0.0),)
    shown_by = "strong accelerations of the joint"
    confused_with = ("link_inertia", "payload")
    stage = "body"
    source = "swevers2007"

    def regressor(self, motion: Motion, joint: int) -> np.ndarray:
        return motion.a[:, [joint]]

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_motion(motion, joint)
