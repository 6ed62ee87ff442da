"""A constant torque at the joint."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import Scales, ServoEffect


@final
class TorqueOffset(ServoEffect):
    """A constant torque at the joint."""

    name = "torque_offset"
    title = "Torque offset"
    formula = "b"
    parameters: ClassVar = (Parameter("b", "b", "N m", "constant torque", -np.inf, np.inf),)
    frees: ClassVar = (("offset",),)
    shown_by = "rests at several gains or with the drive switched off"
    confused_with: ClassVar = ("position_bias",)
    source = "swevers2007"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((0.05 * scales.torque,),)
