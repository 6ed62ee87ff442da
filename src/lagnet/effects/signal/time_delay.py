"""Time delay: torque recorded later than the motion it belongs to."""

from collections.abc import Mapping
from typing import ClassVar, final

import numpy as np

from lagnet.effects.delayed import earlier
from lagnet.effects.effect import Effect, Parameter, Values
from lagnet.effects.excitation import needs_motion
from lagnet.effects.motion import Motion

CLOCK = 0.001  # [s] half a control or integration cycle: by so much stamps of torque and position differ by convention


@final
class TimeDelay(Effect):
    """Torque is logged T later than position: the recording holds τ(t − T), to first order r = −T dτ/dt."""

    name = "time_delay"
    title = "Time delay of the torque"
    formula = "τ(t − T) − τ(t)"
    parameters = (Parameter("T", "T", "s", "time by which torque lags motion", lower=-0.03, upper=0.25),)
    by_convention: ClassVar[Mapping[str, float]] = {"T": CLOCK}
    stage = "signal"
    instantaneous = False
    shown_by = "fast motion with quick changes of torque"
    confused_with = ("viscous_friction", "joint_elasticity", "backlash")
    is_delay = True
    uses_load = True
    source = "swevers2007"

    def columns(self, motion: Motion, joint: int, shape: Mapping[str, float]) -> np.ndarray:
        torque = motion.load if motion.recorded is None else motion.recorded  # holds what the model may still lack
        return -np.gradient(torque[:, joint], motion.time)[:, None]

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        return {"T": float(np.clip(coefficients[0], -0.25, 0.25))}

    def plausible(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> bool:
        return bool(abs(coefficients[0]) <= 0.25)

    def is_determined(self, intervals: Mapping[str, tuple[float, float]]) -> bool:
        low, high = intervals["T"]
        return super().is_determined(intervals) and not (low > -CLOCK and high < CLOCK)

    def torque(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        load = motion.load[:, joint]
        return earlier(motion.time, load, values["T"]) - load

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_motion(motion, joint)
