"""Load-dependent friction: dry friction that grows with the torque through the gear."""

from collections.abc import Collection, Mapping, Sequence
from typing import final

import numpy as np

from lagnet.effects.effect import Effect, Parameter, Values
from lagnet.effects.excitation import needs_both_directions, needs_varying_load
from lagnet.effects.motion import Motion
from lagnet.percent import percent

LINK, MOTOR = 0.0, 1.0  # whose torque presses the teeth
TRIED = (0.126, 0.227)  # for K from 0.09 to 0.3; below, a gain of less than 1 % stands beside the link first
NEAR = 1.35  # times the K about which the motor's side is made linear, or less by as much
SHARP = 0.01  # of K, by which the one about which the law is linear may be off
STEEPEST = 0.95  # from which K on a motor's side would lock the gear


@final
class LoadDependentFriction(Effect):
    """Teeth pressed together harder rub harder: r = K |τ_load| s(v), or r = K |τ_load + r| s(v) on the motor's side.

    On the motor's side r = K |τ_load| s(v) / (1 − K s(v) sign τ_load): the efficiency is 1 − K where the motor drives
    the load, and 1 / (1 + K) where the load drives the motor. In motion that is the link's side with K / (1 − K²) and a
    gain of 1 / (1 − K²): one cause.
    """

    name = "load_dependent_friction"
    title = "Load-dependent friction"
    formula = "K |τ_load| s(v)"
    parameters = (
        Parameter("K", "K", "–", "friction torque per torque carried", lower=0.0, upper=1.0),
        Parameter("side", "side", "–", "0: per torque of the link, 1: of the motor", lower=LINK, upper=MOTOR),
    )
    plain_terms = 3
    shown_by = "motion in both directions under loads that vary, for instance at several inclinations of the link"
    confused_with = ("coulomb_friction",)
    is_friction = True
    is_dry_friction = True
    uses_load = True
    settled = ("side",)
    source = "bittencourt2012"

    def shapes(self, motion: Motion, joint: int) -> Sequence[Values]:
        return {}, *({"K": k, "side": MOTOR} for k in TRIED)

    def free_numbers(self, shape: Mapping[str, float]) -> int:
        return 0  # the K about which the law is made linear is its coefficient

    def sharper_shape(
        self, coefficients: np.ndarray, shape: Mapping[str, float], beside: Collection[str]
    ) -> Values | None:
        k = float(coefficients[0])
        if not _follows_motor(shape):
            motor = {"K": 2.0 * k / (1.0 + np.hypot(1.0, 2.0 * k)), "side": MOTOR}  # k = K / (1 − K²)
            return motor if "torque_gain" in beside and k > 0.0 else None
        return {"K": k, "side": MOTOR} if abs(k - shape["K"]) > SHARP * shape["K"] else None

    def columns(self, motion: Motion, joint: int, shape: Mapping[str, float]) -> np.ndarray:
        return _per_load(motion, joint, shape)[:, None]

    def bounds(self, shape: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        if not _follows_motor(shape):
            return np.zeros(1), np.ones(1)
        return np.array([shape["K"] / NEAR]), np.array([min(shape["K"] * NEAR, STEEPEST)])

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        return {"K": float(coefficients[0]), "side": float(shape.get("side", LINK))}

    def special_case(self, shape: Mapping[str, float]) -> Values | None:
        return {**shape, "side": LINK} if _follows_motor(shape) else None

    def with_names_of_today(self, held: Mapping[str, float]) -> Values:
        return {**super().with_names_of_today(held), "side": float(held.get("side", LINK))}

    def torque(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        return values["K"] * _per_load(motion, joint, values)

    @staticmethod
    def by_power(values: Mapping[str, float]) -> tuple[float, float]:
        """Friction torque per torque of the link: where the motor drives the load, and where that drives the motor."""
        k = values["K"]
        if not _follows_motor(values):
            return k, k
        k = min(k, STEEPEST)
        return k / (1.0 - k), k / (1.0 + k)

    def formula_with(self, values: Mapping[str, float]) -> str:
        return "K |τ_motor| s(v)" if _follows_motor(values) else self.formula

    def remark(self, values: Mapping[str, float]) -> str:
        if not _follows_motor(values):
            return ""
        driving, driven = self.by_power(values)
        return (
            f"per torque of the motor: {percent(driving, 3)} of the link's torque while the motor drives, "
            f"{percent(driven, 3)} while the load does"
        )

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_both_directions(motion, joint) or needs_varying_load(motion, joint)


def _follows_motor(values: Mapping[str, float]) -> bool:
    """Whether values or a shape are of the motor's side; without a side they are of the link's."""
    return values.get("side", LINK) != LINK


def _per_load(motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
    """r / K, shape (n,) [N m]."""
    load, direction = motion.load[:, joint], motion.direction(joint)
    if not _follows_motor(values):
        return np.abs(load) * direction
    return np.abs(load) * direction / (1.0 - min(values["K"], STEEPEST) * direction * np.sign(load))
