"""The gains of the controller are not the nominal ones."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import Scales, ServoEffect


@final
class GainError(ServoEffect):
    """The gains of the controller are not the nominal ones."""

    name = "gain_error"
    title = "Gain error"
    formula = "kp (u − q) − kd v with other gains"
    parameters: ClassVar = (
        Parameter("kp", "kp", "N m/rad", "proportional gain", 0.0, np.inf),
        Parameter("kd", "kd", "N m s/rad", "gain on speed; viscous friction looks alike", 0.0, np.inf),
    )
    frees: ClassVar = (("kp",), ("kd",))
    shown_by = "rests under known loads and follows steps"
    confused_with: ClassVar = ("payload", "joint_spring", "load_dependent_friction")
    source = "swevers2007"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((0.8 * scales.kp, 0.3 * scales.torque / scales.speed),)
