"""Inertia of rotor and gears felt at the joint: τ = Ia a."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import Scales, ServoEffect


@final
class RotorInertia(ServoEffect):
    """Inertia of rotor and gears felt at the joint: τ = Ia a."""

    name = "rotor_inertia"
    title = "Rotor inertia"
    formula = "Ia a"
    parameters: ClassVar = (Parameter("Ia", "Ia", "kg m²", "inertia felt at the joint", 0.0, np.inf),)
    frees: ClassVar = (("rotor",),)
    shown_by = "follows steps and chirps of the command"
    confused_with: ClassVar = ("command_delay", "joint_elasticity")
    source = "swevers2007"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((0.5 * scales.inertia + 1e-3 * scales.kp,),)
