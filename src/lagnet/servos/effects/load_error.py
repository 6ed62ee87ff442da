"""The load of the bodies is a multiple of the nominal load, without saying which body."""

from __future__ import annotations

from typing import ClassVar, final

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import Scales, ServoEffect


@final
class LoadError(ServoEffect):
    """The load of the bodies is a multiple of the nominal load, without saying which body."""

    name = "load_error"
    title = "Load error"
    formula = "g · τ_load"
    parameters: ClassVar = (Parameter("g", "g", "–", "load over nominal load", 0.0, 10.0),)
    frees: ClassVar = (("load_gain",),)
    shown_by = "rests in many poses with a known load"
    confused_with: ClassVar = ("gain_error", "payload")
    source = "swevers2007"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((1.2,),)
