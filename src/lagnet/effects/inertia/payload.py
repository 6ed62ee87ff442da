"""Payload: a rigid body that the last link carries and the model does not know of."""

from collections.abc import Mapping
from typing import final

import numpy as np

from lagnet.effects.effect import Effect, Parameter, Values
from lagnet.effects.excitation import needs_any_motion
from lagnet.effects.motion import Motion
from lagnet.rigid_body.inertia import is_physically_consistent, parameters_of_body, tensor_about_com

INERTIA = ("Ixx", "Ixy", "Iyy", "Ixz", "Iyz", "Izz")  # the order of Pinocchio's dynamic parameters

FARTHEST = 1.0  # [m] that a payload's centre of mass may plausibly lie off the last joint


@final
class Payload(Effect):
    """A tool or grasped object adds mass, weight and inertia to the last link: its regressor times (m, m c, I)."""

    name = "payload"
    title = "Payload on the last link"
    formula = "Y_last(q, v, a) · (m, m c, I)"
    parameters = (
        Parameter("m", "m", "kg", "mass", lower=0.0),
        *(Parameter(f"c{x}", f"c_{x}", "m", f"centre of mass along {x} of the last joint's frame") for x in "xyz"),
        *(Parameter(n, f"I_{{{n[1:]}}}", "kg m²", "inertia about the payload's centre of mass") for n in INERTIA),
    )
    whole_arm = True
    reaches_all = True
    stage = "body"
    needs_bodies = True
    plain_terms = 3
    shown_by = "the wrist held in several orientations, and accelerated"
    confused_with = ("torque_gain", "gravity_tilt", "link_inertia")
    is_body = True
    source = "atkeson1986"

    def columns(self, motion: Motion, joint: int | None, shape: Mapping[str, float]) -> np.ndarray:
        return motion.link_regressor(motion.n_dof - 1)

    def bounds(self, shape: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        return np.array([0.0, *np.full(9, -np.inf)]), np.full(10, np.inf)

    def plausible(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> bool:
        mass = coefficients[0]
        return bool(mass > 0 and np.linalg.norm(coefficients[1:4]) < FARTHEST * mass)

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        mass = float(coefficients[0])
        if not mass > 0:
            return {p.name: 0.0 for p in self.parameters}
        body = np.asarray(coefficients, dtype=float)
        centre, inertia = body[1:4] / mass, tensor_about_com(body)
        moments = [inertia[i, j] for i, j in ((0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2))]
        return dict(zip((p.name for p in self.parameters), map(float, [mass, *centre, *moments]), strict=True))

    def coordinates(self, values: Mapping[str, float]) -> np.ndarray:
        return self.body_parameters(values)

    def from_coordinates(self, coordinates: np.ndarray) -> Values:
        return self.values(coordinates, {})

    def coordinate_bounds(self, values: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        return self.bounds({})

    def body_parameters(self, values: Mapping[str, float]) -> np.ndarray:
        """The ten inertial parameters (m, m c, I about the joint frame), shape (10,)."""
        return parameters_of_body(values["m"], _centre(values), _inertia(values))

    def torque(self, motion: Motion, joint: int | None, values: Mapping[str, float]) -> np.ndarray:
        return motion.body_torque(motion.n_dof - 1, self.body_parameters(values))

    def feasible(self, values: Mapping[str, float]) -> bool:
        return values["m"] > 0 and bool(is_physically_consistent(self.body_parameters(values)))

    def excitation(self, motion: Motion, joint: int | None) -> str | None:
        return needs_any_motion(motion)


def _centre(values: Mapping[str, float]) -> np.ndarray:
    return np.array([values["cx"], values["cy"], values["cz"]])


def _inertia(values: Mapping[str, float]) -> np.ndarray:
    ixx, ixy, iyy, ixz, iyz, izz = (values[n] for n in INERTIA)
    return np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
