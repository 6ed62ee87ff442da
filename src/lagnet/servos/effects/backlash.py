"""Play between motor and link: over 2 b of the motor's way the link is not moved."""

from __future__ import annotations

from typing import ClassVar, final

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import ReversingEffect, Scales

SHARES = (0.1, 0.4)  # of the typical command error, from which fits start


@final
class Backlash(ReversingEffect):
    """Play between motor and link: over 2 b of the motor's way the link is not moved."""

    name = "backlash"
    title = "Backlash"
    formula = "|θ − q| ≤ b between motor and link, with hard stops"
    parameters: ClassVar = (
        Parameter("b", "b", "rad", "half-width of the play between motor and link", 0.0, 0.5),
        Parameter("encoder_side", "s", "", "0: the drive measures at the motor, 1: at the link", 0.0, 1.0),
    )
    frees: ClassVar = (("gap",), ("encoder_side",))
    chosen: ClassVar = ("encoder_side",)
    shown_by = "reverses again and again under loads that change their sign"
    confused_with: ClassVar = ("dead_band", "joint_elasticity", "coulomb_friction", "static_friction", "command_delay")
    source = "swevers2007"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return tuple((share * scales.error, side) for side in (0.0, 1.0) for share in SHARES)
