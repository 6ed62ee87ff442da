"""The drive follows an old command: u(t − T)."""

from __future__ import annotations

from typing import ClassVar, final

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import Scales, ServoEffect


@final
class CommandDelay(ServoEffect):
    """The drive follows an old command: u(t − T)."""

    name = "command_delay"
    title = "Command delay"
    formula = "u(t − T)"
    parameters: ClassVar = (Parameter("T", "T", "s", "age of the command that the drive follows", 0.0, 0.5),)
    frees: ClassVar = (("delay",),)
    shown_by = "follows steps and chirps of the command"
    confused_with: ClassVar = ("viscous_friction", "joint_elasticity", "backlash", "dead_band", "rotor_inertia")
    source = "ljung1999"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((scales.sample,), (3.0 * scales.sample,))
