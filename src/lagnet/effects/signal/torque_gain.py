"""Torque gain: a wrong torque constant or sensor scale."""

from collections.abc import Mapping
from typing import final

import numpy as np

from lagnet.effects.effect import Effect, Parameter, Values
from lagnet.effects.excitation import needs_any_motion
from lagnet.effects.motion import Motion


@final
class TorqueGain(Effect):
    """A wrong torque constant scales every torque of the joint: the recording holds g τ, so that r = (g − 1) τ."""

    name = "torque_gain"
    title = "Torque gain"
    formula = "(g − 1) τ"
    parameters = (Parameter("g", "g", "–", "recorded torque over true torque", lower=0.4, upper=2.5),)
    stage = "signal"
    plain_terms = 3
    shown_by = "several levels of torque"
    confused_with = ("payload", "saturation", "rotor_inertia")
    absent = (("g", 1.0),)
    uses_load = True
    source = "swevers2007"

    def columns(self, motion: Motion, joint: int, shape: Mapping[str, float]) -> np.ndarray:
        return motion.load[:, [joint]]

    def bounds(self, shape: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        return np.array([-0.6]), np.array([1.5])

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        return {"g": 1.0 + float(coefficients[0])}

    def torque(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        return (values["g"] - 1.0) * motion.load[:, joint]

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_any_motion(motion)
