"""Saturation: a torque that the drive or the sensor cannot exceed."""

from collections.abc import Mapping, Sequence
from typing import final

import numpy as np

from lagnet.effects.effect import Effect, Parameter, Values
from lagnet.effects.excitation import needs_any_motion
from lagnet.effects.motion import Motion

WIDE = 1.03  # highest over lowest torque of a plateau: noise, and what a filter leaves of its edges
LEAST_ON_PLATEAU = 0.005  # share of the samples that make a plateau
BEYOND = 0.3  # samples above a plateau, which edges overshoot, over those on it


@final
class Saturation(Effect):
    """The recording stops at a limit while the motion asks for more: r = clip(τ, ±τ_max) − τ."""

    name = "saturation"
    title = "Saturation of the torque"
    formula = "clip(τ, ±τ_max) − τ"
    parameters = (Parameter("tau_max", "τ_max", "N m", "largest torque that is recorded", lower=0.0),)
    stage = "signal"
    shown_by = "motions that ask for high torque"
    confused_with = ("torque_gain",)
    absent = ()
    uses_load = True
    is_limit = True
    source = "swevers2007"

    def shapes(self, motion: Motion, joint: int) -> Sequence[Values]:
        if motion.recorded is None:
            return ()
        limit = plateau(np.abs(motion.recorded[:, joint]))
        if limit is None or not np.any(np.abs(motion.load[:, joint]) > limit):
            return ()
        return ({"tau_max": limit},)

    def columns(self, motion: Motion, joint: int, shape: Mapping[str, float]) -> np.ndarray:
        return self.torque(motion, joint, shape)[:, None]

    def bounds(self, shape: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        return np.array([0.5]), np.array([1.5])

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        return {"tau_max": float(shape["tau_max"])}

    def torque(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        load = motion.load[:, joint]
        return np.clip(load, -values["tau_max"], values["tau_max"]) - load

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_any_motion(motion)


def plateau(size: np.ndarray) -> float | None:
    """Middle of the level near which most of the largest torques lie, None where they do not gather."""
    ordered = np.sort(size)
    on = np.searchsorted(ordered, WIDE * ordered, side="right") - np.arange(size.size)
    beyond = size.size - np.arange(size.size) - on
    gathered = np.where(beyond <= BEYOND * on, on, 0)
    first = int(np.argmax(gathered))
    if gathered[first] < max(LEAST_ON_PLATEAU * size.size, 5) or ordered[first] <= 0.0:
        return None
    return float(np.median(ordered[first : first + on[first]]))
