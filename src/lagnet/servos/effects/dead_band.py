"""No torque while the command error is small: |e| < b."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import Scales, ServoEffect


@final
class DeadBand(ServoEffect):
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

    def excitation(self, command: np.ndarray, q: np.ndarray, moving: np.ndarray) -> str | None:
        if not moving.any():
            return "the joint does not move"
        step = np.diff(q)[moving[1:]]
        if min(np.sum(step > 0.0), np.sum(step < 0.0)) < 0.02 * step.size:
            return "the joint moves in one direction alone"
        return None
