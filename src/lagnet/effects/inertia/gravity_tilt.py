"""Gravity tilt: a base that is not mounted as level as the model believes."""

from collections.abc import Mapping
from typing import final

import numpy as np
from scipy.spatial.transform import Rotation

from lagnet.effects.effect import Effect, Parameter, Values
from lagnet.effects.excitation import needs_any_motion
from lagnet.effects.motion import Motion


@final
class GravityTilt(Effect):
    """The base is rotated against the vertical, so that gravity points elsewhere in its frame: r = Y_g(q) Δg."""

    name = "gravity_tilt"
    title = "Tilted base"
    formula = "Y_g(q) (R(θ)ᵀ g − g)"
    parameters = (
        Parameter("theta_1", "θ_1", "rad", "rotation of the base about its first horizontal axis", -0.6, 0.6),
        Parameter("theta_2", "θ_2", "rad", "rotation of the base about its second horizontal axis", -0.6, 0.6),
    )
    whole_arm = True
    reaches_all = True
    stage = "body"
    needs_bodies = True
    plain_terms = 3
    shown_by = "joints that do not turn about the vertical, in many poses"
    confused_with = ("encoder_offset", "payload", "torque_offset")
    absent = (("theta_1", 0.0), ("theta_2", 0.0))
    source = "swevers2007"

    def columns(self, motion: Motion, joint: int | None, shape: Mapping[str, float]) -> np.ndarray:
        return self._gravity_regressor(motion) @ tilts_of(np.asarray(motion.model.gravity, dtype=float))

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        return {"theta_1": float(coefficients[0]), "theta_2": float(coefficients[1])}

    def gravity_of(self, gravity: np.ndarray, values: Mapping[str, float]) -> np.ndarray:
        """Gravity in the frame of the tilted base, shape (3,) [m/s²]."""
        first, second = horizontal_axes(gravity)
        turn = Rotation.from_rotvec(values["theta_1"] * first + values["theta_2"] * second)
        return turn.inv().as_matrix() @ gravity

    def torque(self, motion: Motion, joint: int | None, values: Mapping[str, float]) -> np.ndarray:
        gravity = np.asarray(motion.model.gravity, dtype=float)
        return self._gravity_regressor(motion) @ (self.gravity_of(gravity, values) - gravity)

    def excitation(self, motion: Motion, joint: int | None) -> str | None:
        return needs_any_motion(motion)

    def _gravity_regressor(self, motion: Motion) -> np.ndarray:
        return motion.remembered("gravity", lambda: motion.model.gravity_regressor(motion.q))


def tilts_of(gravity: np.ndarray) -> np.ndarray:
    """Change of gravity in the frame of the base per unit of each small tilt, shape (3, 2) [m/s² per rad]."""
    first, second = horizontal_axes(gravity)
    return np.column_stack([-np.cross(first, gravity), -np.cross(second, gravity)])


def horizontal_axes(gravity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two unit axes of the base across gravity; x and y of the base where gravity points along z."""
    down = gravity / np.linalg.norm(gravity)
    across = np.eye(3)[0] if abs(down[0]) < 0.9 else np.eye(3)[2]
    first = across - down * (across @ down)
    first /= np.linalg.norm(first)
    return first, np.cross(-down, first)
