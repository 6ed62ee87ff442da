"""A cable bundle, hose or balancing spring pulls the joint back: the motor adds k (q − q0)."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.effect import Scales, ServoEffect

LEAST_RANGE = 0.1  # [rad or m] of positions over which a spring changes its torque


@final
class JointSpring(ServoEffect):
    """A cable bundle, hose or balancing spring pulls the joint back: the motor adds k (q − q0)."""

    name = "joint_spring"
    title = "Joint spring"
    formula = "k (q − q0)"
    parameters: ClassVar = (
        Parameter("k", "k", "N m/rad", "stiffness", 0.0, np.inf),
        Parameter("q0", "q_0", "rad", "position without spring torque", -np.inf, np.inf),
    )
    frees: ClassVar = (("spring",), ("spring_rest",))
    contains: ClassVar = ("torque_offset",)
    shown_by = "rests over a wide range of positions"
    confused_with: ClassVar = ("load_error", "torque_offset", "position_bias", "gain_error")
    source = "swevers2007"

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        return ((0.05 * scales.kp, 0.0),)

    def excitation(self, command: np.ndarray, q: np.ndarray, moving: np.ndarray) -> str | None:
        if np.ptp(q) < LEAST_RANGE:
            return "the joint stays within a narrow range of positions"
        return super().excitation(command, q, moving)
