"""Backlash: a gap between motor and link that the load crosses when it changes sign."""

from collections.abc import Mapping
from typing import final

import numpy as np

from lagnet.effects.effect import Effect, Parameter, Values
from lagnet.effects.excitation import needs_reversals
from lagnet.effects.motion import Motion
from lagnet.effects.shifted import carried_torque, shifted_torque

SMALL = 1e-4  # rad, gap at which the law is made linear
SOFT = 0.05  # of the usual load: within it the flank that carries is not settled


@final
class Backlash(Effect):
    """The link lies against one flank of the gap or the other, as the load pushes: q_l = q − h sign(τ)."""

    name = "backlash"
    title = "Backlash"
    formula = "τ(q − h sign(τ)) − τ(q)"
    parameters = (Parameter("h", "h", "rad", "half the gap between motor and link", lower=0.0, upper=0.2),)
    reaches_all = True
    hears_torque = True
    instantaneous = False
    stage = "body"
    shown_by = "loads that change sign often, and reversals"
    confused_with = ("stribeck_friction", "presliding_hysteresis", "time_delay")
    source = "swevers2007"

    def columns(self, motion: Motion, joint: int, shape: Mapping[str, float]) -> np.ndarray:
        return (_displaced(motion, joint, carried_torque(motion, joint), SMALL) / SMALL)[..., None]

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        return {"h": float(coefficients[0])}

    def torque(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        if values["h"] == 0.0:
            return np.zeros_like(motion.load)
        return _displaced(motion, joint, carried_torque(motion, joint), values["h"])

    def excitation(self, motion: Motion, joint: int) -> str | None:
        load = motion.load[:, joint]
        if not min(np.mean(load > 0), np.mean(load < 0)) > 0.02:
            return "the load never changes sign, so that the same flank always carries it"
        return needs_reversals(motion, joint)


def _displaced(motion: Motion, joint: int, load: np.ndarray, half_gap: float) -> np.ndarray:
    usual = SOFT * float(np.sqrt(np.mean(load**2))) + 1e-12
    lag = half_gap * np.tanh(load / usual)
    speed = np.gradient(lag, motion.time)
    return shifted_torque(motion, joint, -lag, -speed, -np.gradient(speed, motion.time))
