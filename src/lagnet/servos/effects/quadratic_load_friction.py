"""Dry friction with the square of the load: K₂ load² sign(v)."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import ReversingEffect, Scales


@final
class QuadraticLoadFriction(ReversingEffect):
    """Dry friction with the square of the load: K₂ load² sign(v)."""

    name = "quadratic_load_friction"
    title = "Quadratic load friction"
    formula = "K₂ τ_load² sign(v)"
    parameters: ClassVar = (Parameter("K2", "K₂", "1/(N m)", "friction per square of the load", 0.0, np.inf),)
    frees: ClassVar = (("load_squared",),)
    shown_by = "moves several loads in both directions"
    confused_with: ClassVar = ("load_dependent_friction",)
    source = "duclusaud2025"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((0.2 / max(scales.torque, 1e-9),),)
