"""Break-away: a joint at rest starts only beyond Fc + Fs, in motion Fc is felt."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import ReversingEffect, Scales


@final
class StaticFriction(ReversingEffect):
    """Break-away: a joint at rest starts only beyond Fc + Fs, in motion Fc is felt."""

    name = "static_friction"
    title = "Static friction"
    formula = "Fs at rest, beyond Coulomb friction"
    parameters: ClassVar = (
        Parameter("Fs", "Fs", "N m", "break-away torque beyond the friction of motion", 0.0, np.inf),
    )
    frees: ClassVar = (("static",),)
    with_it: ClassVar = ("coulomb",)
    starts_alone: ClassVar = True
    shown_by = "starts slowly from rest, again and again"
    confused_with: ClassVar = ("dead_band", "stribeck_friction", "coulomb_friction")
    source = "armstrong1994"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((0.1 * scales.torque,), (0.4 * scales.torque,))
