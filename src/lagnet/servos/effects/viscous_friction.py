"""Friction in proportion to speed, back-EMF included: τ = Fv v."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import Scales, ServoEffect


@final
class ViscousFriction(ServoEffect):
    """Friction in proportion to speed, back-EMF included: τ = Fv v."""

    name = "viscous_friction"
    title = "Viscous friction"
    formula = "Fv v"
    parameters: ClassVar = (Parameter("Fv", "Fv", "N m s/rad", "friction per speed", 0.0, np.inf),)
    frees: ClassVar = (("viscous",),)
    shown_by = "moves at several speeds"
    confused_with: ClassVar = ("gain_error", "quadratic_drag", "command_delay")
    source = "armstrong1994"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((0.3 * scales.torque / scales.speed,),)
