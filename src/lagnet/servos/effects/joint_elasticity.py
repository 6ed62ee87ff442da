"""Motor and link are joined by a spring: the link trails by load over stiffness, and swings."""

from __future__ import annotations

from math import sqrt
from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import Scales, ServoEffect

RATIOS = (3.0, 15.0)  # of stiffness over the controller's gain, from which fits start
DAMPING = 0.1  # of the critical one, from which fits start


@final
class JointElasticity(ServoEffect):
    """Motor and link are joined by a spring: the link trails by load over stiffness, and swings."""

    name = "joint_elasticity"
    title = "Joint elasticity"
    formula = "K (θ − q) + D (θ' − v) between motor and link"
    parameters: ClassVar = (
        Parameter("K", "K", "N m/rad", "stiffness between motor and link", 0.0, np.inf),
        Parameter("D", "D", "N m s/rad", "damping between motor and link", 0.0, np.inf),
        Parameter("encoder_side", "s", "", "0: the drive measures at the motor, 1: at the link", 0.0, 1.0),
    )
    frees: ClassVar = (("stiffness",), ("twist_damping",), ("encoder_side",))
    chosen: ClassVar = ("encoder_side",)
    shown_by = "starts and stops at once, so that the link swings after the motor"
    confused_with: ClassVar = ("command_delay", "viscous_friction", "backlash", "rotor_inertia", "dead_band")
    source = "deluca2005"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        stiffness = [ratio * scales.kp for ratio in RATIOS]
        return tuple((k, 2.0 * DAMPING * sqrt(k * scales.inertia), side) for side in (0.0, 1.0) for k in stiffness)
