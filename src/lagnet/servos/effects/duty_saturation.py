"""The torque of the controller is limited, by duty and supply: |τ| ≤ τ_max."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import Scales, ServoEffect


@final
class DutySaturation(ServoEffect):
    """The torque of the controller is limited, by duty and supply: |τ| ≤ τ_max."""

    name = "duty_saturation"
    title = "Duty saturation"
    formula = "clip(τ, ±τ_max)"
    parameters: ClassVar = (Parameter("tau_max", "τ_max", "N m", "greatest torque of the controller", 0.0, np.inf),)
    frees: ClassVar = (("torque_limit",),)
    shown_by = "jumps far, so that the command error is large"
    confused_with: ClassVar = ("gain_error", "quadratic_drag", "viscous_friction")
    source = "duclusaud2025"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return tuple((share * scales.torque,) for share in (1.0, 1.5, 2.5))
