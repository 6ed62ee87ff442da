"""Dry friction in proportion to the load, alike in both directions of power: K |load| sign(v)."""

from __future__ import annotations

from typing import ClassVar, final

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import ReversingEffect, Scales


@final
class LoadDependentFriction(ReversingEffect):
    """Dry friction in proportion to the load, alike in both directions of power: K |load| sign(v)."""

    name = "load_dependent_friction"
    title = "Load-dependent friction"
    formula = "K |τ_load| sign(v)"
    parameters: ClassVar = (Parameter("K", "K", "–", "friction per load", 0.0, 10.0),)
    frees: ClassVar = (("load_driving", "load_driven"),)
    shown_by = "moves several loads in both directions"
    confused_with: ClassVar = ("coulomb_friction", "gain_error", "directional_load_friction", "quadratic_load_friction")
    source = "duclusaud2025"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((0.2,), (0.8,))
