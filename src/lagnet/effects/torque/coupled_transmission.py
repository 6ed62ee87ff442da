"""Coupled transmission: a motor that turns with two joints, and whose friction and rotor both of them feel."""

from collections.abc import Mapping, Sequence
from typing import final

import numpy as np

from lagnet.effects.effect import Effect, Parameter, Values
from lagnet.effects.excitation import needs_both_directions
from lagnet.effects.motion import Motion

SENSES = (1.0, -1.0)


@final
class CoupledTransmission(Effect):
    """The motor of a wrist joint also turns with the joint before it: with w = v_j ± v_(j−1), both feel its drag.

    Power balance gives the share of each joint: r_j = Fv w + Fc s(w) + Ia dw/dt, and r_(j−1) = ± r_j.
    """

    name = "coupled_transmission"
    title = "Coupled transmission"
    formula = "Fv w + Fc s(w) + Ia dw/dt on both joints, w = v_j ± v_(j−1)"
    parameters = (
        Parameter("Fv", "F_v", "N m s/rad", "viscous friction of the coupled motor", lower=0.0),
        Parameter("Fc", "F_c", "N m", "dry friction of the coupled motor", lower=0.0),
        Parameter("Ia", "I_a", "kg m²", "rotor inertia of the coupled motor", lower=0.0),
        Parameter("sense", "c", "–", "+1 where the motor turns with the sum of the speeds, −1 with the difference"),
    )
    reaches_all = True
    absent = (("Fv", 0.0), ("Fc", 0.0), ("Ia", 0.0))
    shown_by = "both joints of the pair moving in both directions, together and against each other"
    confused_with = ("viscous_friction", "coulomb_friction", "rotor_inertia")
    source = "gautier1990"

    def shapes(self, motion: Motion, joint: int) -> Sequence[Values]:
        return tuple({"sense": sense} for sense in SENSES)

    def columns(self, motion: Motion, joint: int, shape: Mapping[str, float]) -> np.ndarray:
        sense = shape["sense"]
        speed = motion.v[:, joint] + sense * motion.v[:, joint - 1]
        blur = float(np.hypot(motion.slow[joint], motion.slow[joint - 1]))
        own = np.column_stack([speed, np.tanh(speed / blur), motion.a[:, joint] + sense * motion.a[:, joint - 1]])
        out = np.zeros((motion.time.size, motion.n_dof, 3))
        out[:, joint], out[:, joint - 1] = own, sense * own
        return out

    def bounds(self, shape: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        return np.zeros(3), np.full(3, np.inf)

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        viscous, dry, rotor = map(float, coefficients)
        return {"Fv": viscous, "Fc": dry, "Ia": rotor, "sense": float(shape["sense"])}

    def coordinate_bounds(self) -> tuple[np.ndarray, np.ndarray]:
        return np.array([0.0, 0.0, 0.0, -1.0]), np.array([np.inf, np.inf, np.inf, 1.0])

    def torque(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        sense = {"sense": 1.0 if values["sense"] >= 0.0 else -1.0}
        return self.columns(motion, joint, sense) @ np.array([values["Fv"], values["Fc"], values["Ia"]])

    def plausible(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> bool:
        return bool(np.all(coefficients[:2] > 0.0) and coefficients[2] > -0.1 * abs(coefficients[0]))

    def exists_at(self, joint: int | None) -> bool:
        return joint != 0  # no joint is before the first

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_both_directions(motion, joint) or needs_both_directions(motion, joint - 1)
