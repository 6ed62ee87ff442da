"""Presliding hysteresis: friction that builds up over a distance after each reversal."""

from collections.abc import Mapping, Sequence
from typing import final

import numpy as np

from lagnet.effects.bristle import bristle
from lagnet.effects.effect import Parameter, StateEffect, Values
from lagnet.effects.excitation import needs_reversals
from lagnet.effects.motion import Motion

DISTANCES = 6  # presliding distances tried
REACH = (0.002, 0.15)  # shortest and longest of them, in ranges of the joint


@final
class PreslidingHysteresis(StateEffect):
    """Bristles between the surfaces bend before they slide (Dahl): ż = v − |v| z σ0/Fc, r = σ0 z."""

    name = "presliding_hysteresis"
    title = "Presliding hysteresis"
    formula = "σ0 z with ż = v − |v| σ0 z / Fc"
    parameters = (
        Parameter("sigma0", "σ_0", "N m/rad", "stiffness of the bristles", lower=0.0),
        Parameter("Fc", "F_c", "N m", "friction once sliding", lower=0.0),
    )
    instantaneous = False
    shown_by = "slow reversals and small back-and-forth motions"
    confused_with = ("backlash", "stribeck_friction", "coulomb_friction")
    contains = ("coulomb_friction",)
    plain_terms = 2
    absent = (("Fc", 0.0),)
    is_friction = True
    is_dry_friction = True
    source = "canudas1995"

    def shapes(self, motion: Motion, joint: int) -> Sequence[Values]:
        reach = float(np.ptp(motion.q[:, joint]))
        if not reach > 0:
            return ()
        return tuple({"distance": float(d)} for d in np.geomspace(REACH[0] * reach, REACH[1] * reach, DISTANCES))

    def columns(self, motion: Motion, joint: int, shape: Mapping[str, float]) -> np.ndarray:
        return bristle(motion.q[:, joint], shape["distance"])[:, None]

    def bounds(self, shape: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        return np.zeros(1), np.full(1, np.inf)

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        friction = float(coefficients[0])
        return {"sigma0": friction / float(shape["distance"]), "Fc": friction}

    def torque(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        if values["Fc"] <= 0.0 or values["sigma0"] <= 0.0:
            return np.zeros(motion.time.size)
        return values["Fc"] * bristle(motion.q[:, joint], values["Fc"] / values["sigma0"])

    def init_state(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        return np.zeros(1)

    def derivative(self, state: np.ndarray, q: float, v: float, load: float, values: Mapping[str, float]) -> np.ndarray:
        return v - abs(v) * values["sigma0"] * state / max(values["Fc"], 1e-12)

    def left_of_start(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        travel = np.cumsum(np.abs(np.diff(motion.q[:, joint], prepend=motion.q[:1, joint])))
        return np.exp(-travel * values["sigma0"] / max(values["Fc"], 1e-12))

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_reversals(motion, joint)
