"""Dry friction of one size: |τ| ≤ Fc at rest, Fc sign(v) in motion."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import ReversingEffect, Scales


@final
class CoulombFriction(ReversingEffect):
    """Dry friction of one size: |τ| ≤ Fc at rest, Fc sign(v) in motion."""

    name = "coulomb_friction"
    title = "Coulomb friction"
    formula = "Fc sign(v)"
    parameters: ClassVar = (Parameter("Fc", "Fc", "N m", "dry friction", 0.0, np.inf),)
    frees: ClassVar = (("coulomb",),)
    shown_by = "approaches the same goal from both sides"
    confused_with: ClassVar = ("dead_band", "load_dependent_friction", "static_friction")
    source = "armstrong1994"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((0.2 * scales.torque,),)
