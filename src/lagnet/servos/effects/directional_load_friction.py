"""Dry friction per load that differs by whether the motor moves the load or the load drives the motor."""

from __future__ import annotations

from typing import ClassVar, final

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import ReversingEffect, Scales


@final
class DirectionalLoadFriction(ReversingEffect):
    """Dry friction per load that differs by whether the motor moves the load or the load drives the motor."""

    name = "directional_load_friction"
    title = "Directional load friction"
    formula = "K₊ |τ_load| sign(v) or K₋ |τ_load| sign(v)"
    parameters: ClassVar = (
        Parameter("K_driving", "K₊", "–", "friction per load while the motor moves the load", 0.0, 10.0),
        Parameter("K_driven", "K₋", "–", "friction per load while the load drives the motor", 0.0, 10.0),
    )
    frees: ClassVar = (("load_driving",), ("load_driven",))
    contains: ClassVar = ("load_dependent_friction",)
    shown_by = "moves several loads in both directions"
    confused_with: ClassVar = ("load_dependent_friction", "gain_error")
    source = "duclusaud2025"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((0.5, 0.2), (0.2, 0.8))
