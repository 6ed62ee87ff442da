"""Joint elasticity: a gear or belt that gives under load, with the encoder on the motor's side."""

from collections.abc import Mapping
from typing import final

import numpy as np

from lagnet.effects.damped import damped
from lagnet.effects.effect import Parameter, Values
from lagnet.effects.excitation import needs_motion
from lagnet.effects.motion import Motion
from lagnet.effects.shifted import carried_torque
from lagnet.effects.slopes import first_order
from lagnet.effects.transmission import Shift, Transmission

LONGEST = 0.25  # [s] time constant D/K of a damped spring: slower ones are no joints


@final
class JointElasticity(Transmission):
    """The link trails the motor by e, K e + D de/dt = τ: r = τ(q_l, v_l, a_l) − τ(q, v, a) with q_l = q − e."""

    name = "joint_elasticity"
    title = "Joint elasticity"
    formula = "τ(q − e) − τ(q), K e + D ė = τ"
    parameters = (
        Parameter("K", "K", "N m/rad", "stiffness of the transmission", lower=1e-3),
        Parameter("D", "D", "N m s/rad", "damping of the transmission", lower=0.0),
    )
    uses_measured_torque = True
    shown_by = "quick changes of load and acceleration at the joint"
    confused_with = ("encoder_offset", "link_inertia", "rotor_inertia", "time_delay")
    absent = ()
    source = "swevers2007"

    def columns(self, motion: Motion, joint: int, shape: Mapping[str, float]) -> np.ndarray:
        """To first order in the compliance 1/K, without damping."""
        return first_order(motion, joint, *_lag(motion, carried_torque(motion, joint)))[..., None]

    def bounds(self, shape: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        return np.zeros(1), np.full(1, np.inf)

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        return {"K": 1.0 / max(float(coefficients[0]), 1e-12), "D": 0.0}

    def special_case(self, shape: Mapping[str, float]) -> Values | None:
        return {"D": 0.0} if shape.get("D", 0.0) > 0.0 else None

    def chosen(self, values: Mapping[str, float]) -> np.ndarray:
        return np.array([False, self.special_case(values) is None])

    def with_names_of_today(self, held: Mapping[str, float]) -> Values:
        return {"D": 0.0, **super().with_names_of_today(held)}

    def coordinates(self, values: Mapping[str, float]) -> np.ndarray:
        return np.array([1.0 / values["K"], _constant(values)])

    def from_coordinates(self, coordinates: np.ndarray) -> Values:
        compliance, constant = map(float, coordinates)
        stiffness = 1.0 / max(compliance, 1e-12)
        return {"K": stiffness, "D": constant * stiffness}

    def coordinate_bounds(self, values: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        return np.zeros(2), np.array([1e3, LONGEST])

    def shift(self, motion: Motion, joint: int, values: Mapping[str, float]) -> Shift:
        wound = damped(motion.time, carried_torque(motion, joint), _constant(values))
        return _lag(motion, wound / values["K"])

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_motion(motion, joint)


def _constant(values: Mapping[str, float]) -> float:
    """Time constant D/K [s], 0 without a damper."""
    return values.get("D", 0.0) / values["K"]


def _lag(motion: Motion, bend: np.ndarray) -> Shift:
    """Position, speed and acceleration of the link less those of its motor, which it trails by `bend`, shape (n,)."""
    speed = np.gradient(bend, motion.time)
    return -bend, -speed, -np.gradient(speed, motion.time)
