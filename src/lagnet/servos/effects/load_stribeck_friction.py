"""Load-dependent friction that falls with speed, as lubricated teeth do: K |τ| (1 + s exp(−(v/vs)²)) sign(v)."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import ReversingEffect, Scales


@final
class LoadStribeckFriction(ReversingEffect):
    """Load-dependent friction that falls with speed, as lubricated teeth do: K |τ| (1 + s exp(−(v/vs)²)) sign(v)."""

    name = "load_stribeck_friction"
    title = "Load-dependent Stribeck friction"
    formula = "K |τ| (1 + s exp(−(v/vs)²)) sign(v)"
    parameters: ClassVar = (
        Parameter("s", "s", "–", "further share of load-dependent friction near rest", 0.0, 10.0),
        Parameter("vs", "vs", "rad/s", "speed over which it fades", 0.0, np.inf),
    )
    frees: ClassVar = (("load_stribeck",), ("stribeck_speed",))
    beside: ClassVar = (
        "load_dependent_friction",
        "directional_load_friction",
        "quadratic_load_friction",
        "gear_friction",
    )
    shown_by = "moves loads at many low speeds"
    confused_with: ClassVar = ("stribeck_friction", "static_friction", "dead_band")
    source = "duclusaud2025"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((0.3, 0.3 * scales.speed),)
