"""No torque while the command error is small: |e| < b."""

from __future__ import annotations

from typing import ClassVar, final

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import ReversingEffect, Scales


@final
class DeadBand(ReversingEffect):
    """No torque while the command error is small: |e| < b."""

    name = "dead_band"
    title = "Dead band"
    formula = "kp sign(e) max(|e| − b, 0)"
    parameters: ClassVar = (Parameter("b", "b", "rad", "half-width of the error that gives no torque", 0.0, 0.5),)
    frees: ClassVar = (("dead_band",),)
    shown_by = "approaches goals slowly from both sides under several loads"
    confused_with: ClassVar = ("coulomb_friction", "static_friction", "backlash", "command_delay")
    source = "slotine1991"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((0.2 * scales.error,),)
