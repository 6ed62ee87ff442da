"""The drive sees the joint beside where it was recorded: e = u − q − δ."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import Scales, ServoEffect


@final
class PositionBias(ServoEffect):
    """The drive sees the joint beside where it was recorded: e = u − q − δ."""

    name = "position_bias"
    title = "Position bias"
    formula = "kp (u − q − δ)"
    parameters: ClassVar = (
        Parameter(
            "delta", "δ", "rad", "offset between the position the drive sees and the recorded one", -np.inf, np.inf
        ),
    )
    frees: ClassVar = (("bias",),)
    shown_by = "rests without load in many poses"
    confused_with: ClassVar = ("torque_offset",)
    source = "slotine1991"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((0.01 * scales.error,),)
