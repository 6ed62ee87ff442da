"""Dry friction in proportion to the torque at both sides of a gear: K (|τ_motor| + |τ_load|) sign(v)."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import Scales, ServoEffect


@final
class GearFriction(ServoEffect):
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

    def excitation(self, command: np.ndarray, q: np.ndarray, moving: np.ndarray) -> str | None:
        if not moving.any():
            return "the joint does not move"
        step = np.diff(q)[moving[1:]]
        if min(np.sum(step > 0.0), np.sum(step < 0.0)) < 0.02 * step.size:
            return "the joint moves in one direction alone"
        return None
