"""Dry friction that falls with speed: (Fc + Fs exp(−(v/vs)²)) sign(v)."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import ReversingEffect, Scales


@final
class StribeckFriction(ReversingEffect):
    """Dry friction that falls with speed: (Fc + Fs exp(−(v/vs)²)) sign(v)."""

    name = "stribeck_friction"
    title = "Stribeck friction"
    formula = "(Fc + Fs exp(−(v/vs)²)) sign(v)"
    parameters: ClassVar = (
        Parameter("Fc", "Fc", "N m", "dry friction at speed", 0.0, np.inf),
        Parameter("Fs", "Fs", "N m", "further friction near rest", 0.0, np.inf),
        Parameter("vs", "vs", "rad/s", "speed over which it fades", 0.0, np.inf),
    )
    frees: ClassVar = (("coulomb",), ("static",), ("stribeck_speed",))
    contains: ClassVar = ("coulomb_friction", "static_friction")
    shown_by = "moves at many low speeds"
    confused_with: ClassVar = ("static_friction", "coulomb_friction", "dead_band")
    source = "armstrong1994"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((0.1 * scales.torque, 0.1 * scales.torque, 0.3 * scales.speed),)
