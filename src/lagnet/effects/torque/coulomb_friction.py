"""Coulomb friction: constant torque against the direction of motion."""

from typing import final

import numpy as np

from lagnet.effects.effect import LinearEffect, Parameter
from lagnet.effects.excitation import needs_both_directions
from lagnet.effects.motion import Motion


@final
class CoulombFriction(LinearEffect):
    """Dry contact resists with a torque that depends on the direction of motion alone: r = Fc s(v)."""

    name = "coulomb_friction"
    title = "Coulomb friction"
    formula = "Fc s(v)"
    parameters = (Parameter("Fc", "F_c", "N m", "torque against the motion, equal both ways", lower=0.0),)
    shown_by = "motion in both directions"
    confused_with = ("asymmetric_friction", "stribeck_friction", "load_dependent_friction")
    is_friction = True
    is_dry_friction = True
    function_of_speed = True
    source = "swevers2007"

    def regressor(self, motion: Motion, joint: int) -> np.ndarray:
        return motion.direction(joint)[:, None]

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_both_directions(motion, joint)
