"""Dry friction per load that differs by whether the motor moves the load or the load drives the motor."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import Scales, ServoEffect


@final
class DirectionalLoadFriction(ServoEffect):
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

    def excitation(self, command: np.ndarray, q: np.ndarray, moving: np.ndarray) -> str | None:
        if not moving.any():
            return "the joint does not move"
        step = np.diff(q)[moving[1:]]
        if min(np.sum(step > 0.0), np.sum(step < 0.0)) < 0.02 * step.size:
            return "the joint moves in one direction alone"
        return None
