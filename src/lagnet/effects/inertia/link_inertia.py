"""Link inertia: a link whose mass, centre of mass or inertia the model has wrong."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import final

import numpy as np

from lagnet.effects.effect import LinearEffect, Parameter, Values
from lagnet.effects.excitation import needs_any_motion
from lagnet.effects.motion import Motion
from lagnet.rigid_body.inertia import parameters_of_body

FREE, MASS = 0.0, 1.0  # whether all ten parameters are fitted, or the mass alone with the others in its ratio
NO_LINK = -1.0  # share of a link's mass by which it is less: none is left
NAMES = ("dm", "dmcx", "dmcy", "dmcz", "dIxx", "dIxy", "dIyy", "dIxz", "dIyz", "dIzz")
UNITS = ("kg", "kg m", "kg m", "kg m", *("kg m²",) * 6)
MEANINGS = (
    "change of mass",
    *("change of first moment of mass",) * 3,
    *("change of inertia about the joint frame",) * 6,
)


@final
class LinkInertia(LinearEffect):
    """A link is heavier, lighter or balanced otherwise than modelled: its regressor times the change of its parameters.

    Where the mass alone is wrong, Δπ = s π_k of the modelled link: one column. The last link is left to `payload`,
    which is the same torque under the name that users expect.
    """

    name = "link_inertia"
    title = "Wrong inertial parameters of a link"
    formula = "Y_k(q, v, a) · Δπ_k"
    parameters = (
        *(Parameter(n, f"Δ{n[1:]}", u, m) for n, u, m in zip(NAMES, UNITS, MEANINGS, strict=True)),
        Parameter("form", "form", "–", "0: each of the ten by itself, 1: the mass alone", lower=FREE, upper=MASS),
    )
    reaches_all = True
    needs_bodies = True
    stage = "body"
    plain_terms = 3
    shown_by = "all joints moving at once, with strong accelerations and in many poses"
    confused_with = ("payload", "rotor_inertia", "gravity_tilt", "torque_gain")
    absent = tuple((n, 0.0) for n in NAMES)
    is_body = True
    changes_link = True
    settled = ("form",)
    source = "gautier1990"

    def regressor(self, motion: Motion, joint: int) -> np.ndarray:
        return motion.link_regressor(joint)

    def shapes(self, motion: Motion, joint: int) -> Sequence[Values]:
        return {}, *mass_alone(motion.link_parameters(joint))[:1]

    def columns(self, motion: Motion, joint: int, shape: Mapping[str, float]) -> np.ndarray:
        return in_form(self.regressor(motion, joint), shape)

    def bounds(self, shape: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        if is_mass_alone(shape):
            return np.full(1, NO_LINK), np.full(1, np.inf)
        return np.full(len(NAMES), -np.inf), np.full(len(NAMES), np.inf)

    def free_numbers(self, shape: Mapping[str, float]) -> int:
        return 0  # the direction follows from the model

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        if not is_mass_alone(shape):
            return {**dict(zip(NAMES, map(float, coefficients), strict=True)), "form": FREE}
        return {**{n: float(coefficients[0]) * shape[n] for n in NAMES}, "form": MASS}

    def with_names_of_today(self, held: Mapping[str, float]) -> Values:
        return {**super().with_names_of_today(held), "form": float(held.get("form", FREE))}

    def coordinates(self, values: Mapping[str, float]) -> np.ndarray:
        return np.array([values["dm"]]) if is_mass_alone(values) else _ten(values)

    def moved(self, values: Mapping[str, float], coordinates: np.ndarray) -> Values:
        if not is_mass_alone(values):
            return super().moved(values, coordinates)
        ratio = float(coordinates[0]) / values["dm"] if values["dm"] else 0.0
        return {**values, **{n: ratio * values[n] for n in NAMES}}

    def coordinate_bounds(self, values: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        free = np.full(1 if is_mass_alone(values) else len(NAMES), np.inf)
        return -free, free

    def told(self, values: Mapping[str, float]) -> tuple[str, ...]:
        return NAMES[:1] if is_mass_alone(values) else NAMES

    def body_parameters(self, values: Mapping[str, float]) -> np.ndarray:
        return _ten(values)

    def torque(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        return motion.body_torque(joint, _ten(values))

    def remark(self, values: Mapping[str, float]) -> str:
        return "the mass alone, its centre as modelled" if is_mass_alone(values) else ""

    def plausible(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> bool:
        return bool(np.all(np.isfinite(coefficients))) and not (is_mass_alone(shape) and coefficients[0] <= NO_LINK)

    def excitation(self, motion: Motion, joint: int) -> str | None:
        if joint == motion.n_dof - 1:
            return "a change of the last link is a payload"
        return needs_any_motion(motion)


def mass_alone(body: np.ndarray) -> tuple[Values, ...]:
    """Shapes of a link of another mass, its centre of mass as modelled: Δπ where the mass is twice the modelled one.

    The inertia about the centre grows with the mass, or stays as it is. None for a link without mass.

    Args:
        body: shape (10,), inertial parameters of the modelled link.
    """
    if not body[0] > 0.0:
        return ()
    alone = parameters_of_body(body[0], body[1:4] / body[0], np.zeros((3, 3)))
    return tuple({**dict(zip(NAMES, map(float, d), strict=True)), "form": MASS} for d in (body, alone))


def in_form(columns: np.ndarray, shape: Mapping[str, float]) -> np.ndarray:
    """Torque per unit of the coefficients of a shape, (..., 10) or (..., 1), from that of the ten, (..., 10)."""
    return columns @ _ten(shape)[:, None] if is_mass_alone(shape) else columns


def is_mass_alone(values: Mapping[str, float]) -> bool:
    """Whether values or a shape are of a mass alone; without a form all ten parameters are free."""
    return values.get("form", FREE) != FREE


def _ten(values: Mapping[str, float]) -> np.ndarray:
    return np.array([values[n] for n in NAMES])
