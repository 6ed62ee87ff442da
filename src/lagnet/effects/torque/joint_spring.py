"""Joint spring: torque that pulls the joint towards a rest position."""

from collections.abc import Mapping
from typing import final

import numpy as np

from lagnet.effects.effect import Effect, Parameter, Values
from lagnet.effects.excitation import needs_position_range
from lagnet.effects.motion import Motion


@final
class JointSpring(Effect):
    """A cable bundle, hose or balancing spring pulls the joint back: the motor adds r = k (q − q0)."""

    name = "joint_spring"
    title = "Joint spring"
    formula = "k (q − q0)"
    parameters = (
        Parameter("k", "k", "N m/rad", "stiffness", lower=0.0),
        Parameter("q0", "q_0", "rad", "position without spring torque"),
    )
    shown_by = "a wide range of positions of the joint"
    confused_with = ("torque_ripple", "gravity_tilt", "encoder_offset", "torque_offset")
    contains = ("torque_offset",)
    source = "swevers2007"

    def columns(self, motion: Motion, joint: int, shape: Mapping[str, float]) -> np.ndarray:
        q = motion.q[:, joint]
        return np.column_stack([q, np.ones_like(q)])

    def bounds(self, shape: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        return np.array([0.0, -np.inf]), np.full(2, np.inf)

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        stiffness, constant = float(coefficients[0]), float(coefficients[1])
        return {"k": stiffness, "q0": -constant / stiffness if stiffness > 0 else 0.0}

    def torque(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        return values["k"] * (motion.q[:, joint] - values["q0"])

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_position_range(motion, joint)
