"""Stribeck friction: dry friction that is larger at low speed than at high speed."""

from collections.abc import Mapping, Sequence
from typing import final

import numpy as np

from lagnet.effects.effect import Effect, Parameter, Values
from lagnet.effects.excitation import needs_slow_passes
from lagnet.effects.motion import Motion

GRID = 9  # Stribeck speeds tried between the blurred zone and the usual speed of the joint


@final
class StribeckFriction(Effect):
    """Friction falls as a lubricant film builds up with speed: r = (Fc + Fs exp(−(v/vs)²)) s(v)."""

    name = "stribeck_friction"
    title = "Stribeck friction"
    formula = "(Fc + Fs exp(−(v/vs)²)) s(v)"
    parameters = (
        Parameter("Fc", "F_c", "N m", "dry friction at speed", lower=0.0),
        Parameter("Fs", "F_s", "N m", "extra friction close to standstill", lower=0.0),
        Parameter("vs", "v_s", "rad/s", "speed at which the extra friction has fallen to 1/e", lower=0.0),
    )
    shown_by = "slow passes through zero speed"
    confused_with = ("coulomb_friction", "backlash", "presliding_hysteresis")
    plain_terms = 3
    contains = ("coulomb_friction",)
    absent = (("Fc", 0.0), ("Fs", 0.0))
    is_friction = True
    is_dry_friction = True
    function_of_speed = True
    source = "armstrong1994"

    def shapes(self, motion: Motion, joint: int) -> Sequence[Values]:
        usual = float(np.sqrt(np.mean(motion.v[:, joint] ** 2)))
        lowest = 3.0 * motion.slow[joint]
        if not usual > 1.5 * lowest:
            return ()
        return tuple({"vs": float(vs)} for vs in np.geomspace(lowest, usual, GRID))

    def columns(self, motion: Motion, joint: int, shape: Mapping[str, float]) -> np.ndarray:
        direction = motion.direction(joint)
        return np.column_stack([direction, _boundary_share(motion.v[:, joint], shape["vs"]) * direction])

    def bounds(self, shape: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        return np.zeros(2), np.full(2, np.inf)

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        return {"Fc": float(coefficients[0]), "Fs": float(coefficients[1]), "vs": float(shape["vs"])}

    def further_term(self, values: Mapping[str, float], speed: np.ndarray) -> tuple[str, float] | None:
        seen = float(np.max(_boundary_share(speed, values["vs"]), initial=0.0))
        return "coulomb_friction", seen * values["Fs"] / max(values["Fc"], 1e-300)

    def torque(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        return self.columns(motion, joint, values) @ np.array([values["Fc"], values["Fs"]])

    def excitation(self, motion: Motion, joint: int) -> str | None:
        blurred = (
            None if self.shapes(motion, joint) else "the speeds do not reach far enough above those that noise blurs"
        )
        return needs_slow_passes(motion, joint) or blurred


def _boundary_share(v: np.ndarray, vs: float) -> np.ndarray:
    """exp(−(v/vs)²), shape (n,), of speeds v (n,) [rad/s]; its limit at vs = 0: 1 at standstill, 0 at any speed."""
    if vs == 0.0:
        return (v == 0.0).astype(float)
    with np.errstate(over="ignore"):  # a vs next to zero: exp(−∞) = 0
        return np.exp(-((v / vs) ** 2))
