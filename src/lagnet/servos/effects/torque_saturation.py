"""The motor's torque grows less than its duty: x / (1 + σ |x|), x the torque in proportion to duty.

A motor near its stall loses torque: its windings heat up, its iron saturates, its supply gives way. Where the duty was
recorded, it shows that the controller is not the one that is not straight.
"""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import Scales, ServoEffect


@final
class TorqueSaturation(ServoEffect):
    """The motor's torque grows less than its duty: x / (1 + σ |x|), x the torque in proportion to duty."""

    name = "torque_saturation"
    title = "Torque saturation"
    formula = "x / (1 + σ |x|)"
    parameters: ClassVar = (
        Parameter("sigma", "σ", "1/(N m)", "share of the torque that is lost, per torque", 0.0, np.inf),
    )
    frees: ClassVar = (("saturation",),)
    with_it: ClassVar = ("kp",)
    shown_by = "moves and rests at small and large command errors, its duty recorded"
    confused_with: ClassVar = ("duty_saturation", "gear_friction", "quadratic_load_friction", "gain_error")
    source = "duclusaud2025"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((0.2 / max(scales.torque, 1e-9),), (0.8 / max(scales.torque, 1e-9),))
