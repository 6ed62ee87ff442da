"""Dry friction of one size: |τ| ≤ Fc at rest, Fc sign(v) in motion."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import Scales, ServoEffect


@final
class CoulombFriction(ServoEffect):
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

    def excitation(self, command: np.ndarray, q: np.ndarray, moving: np.ndarray) -> str | None:
        if not moving.any():
            return "the joint does not move"
        step = np.diff(q)[moving[1:]]
        if min(np.sum(step > 0.0), np.sum(step < 0.0)) < 0.02 * step.size:
            return "the joint moves in one direction alone"
        return None
