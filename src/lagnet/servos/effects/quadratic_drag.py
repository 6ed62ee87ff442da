"""Drag with the square of speed: Fd v |v|."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import Scales, ServoEffect


@final
class QuadraticDrag(ServoEffect):
    """Drag with the square of speed: Fd v |v|."""

    name = "quadratic_drag"
    title = "Quadratic drag"
    formula = "Fd v |v|"
    parameters: ClassVar = (Parameter("Fd", "Fd", "N m s²/rad²", "drag per square of speed", 0.0, np.inf),)
    frees: ClassVar = (("quadratic",),)
    shown_by = "moves at several speeds"
    confused_with: ClassVar = ("viscous_friction", "duty_saturation")
    source = "swevers2007"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((0.2 * scales.torque / scales.speed**2,),)
