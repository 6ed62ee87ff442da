"""Dry friction in proportion to the torque at both sides of a gear: K (|τ_motor| + |τ_load|) sign(v)."""

from __future__ import annotations

from typing import ClassVar, final

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import ReversingEffect, Scales


@final
class GearFriction(ReversingEffect):
    """Dry friction in proportion to the torque at both sides of a gear: K (|τ_motor| + |τ_load|) sign(v)."""

    name = "gear_friction"
    title = "Gear friction"
    formula = "K (|τ_motor| + |τ_load|) sign(v)"
    parameters: ClassVar = (Parameter("K", "K", "–", "friction per torque of motor and load", 0.0, 0.9),)
    frees: ClassVar = (("load_motor", "load_driving", "load_driven"),)
    contains: ClassVar = ("load_dependent_friction",)
    shown_by = "moves several loads in both directions, fast and slowly"
    confused_with: ClassVar = (
        "load_dependent_friction",
        "directional_load_friction",
        "quadratic_load_friction",
        "gain_error",
    )
    source = "duclusaud2025"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((0.1,), (0.4,))
