"""What the catalogues of torque and of servos say of a followed effect: where it acts, and bounds of its parameters."""

from __future__ import annotations

import numpy as np

from lagnet.effects.catalogue import CATALOGUE, effect_named
from lagnet.servos.catalogue import SERVO_CATALOGUE, servo_effect

SERVO_FRICTION = ("friction", "drag")  # how the names of those effects of a servo end that load and warmth change


def stage_of(effect: str) -> str:
    """ "torque" for friction and the like, "body" for bodies and transmissions, else where a servo or signal has it.

    Raises:
        EffectError: neither catalogue has such a name.
    """
    if effect in CATALOGUE or effect not in SERVO_CATALOGUE:
        stage = effect_named(effect).stage
        return "body" if stage == "transmission" else stage
    return "torque" if effect.endswith(SERVO_FRICTION) else "signal"


def lower_bound(effect: str, parameter: str) -> float:
    """The least value that physics allows; −∞ for a parameter that no catalogue knows.

    A ratio such as Fc/kp has the bound of its numerator.

    Raises:
        EffectError: neither catalogue has such an effect.
    """
    known = [] if effect in CATALOGUE or effect not in SERVO_CATALOGUE else [servo_effect(effect)]
    known = known or [effect_named(effect), *([servo_effect(effect)] if effect in SERVO_CATALOGUE else [])]
    name = parameter.removesuffix("/kp")
    return next((p.lower for law in known for p in law.parameters if p.name == name), -np.inf)
