"""Gravity tilt: a base that is not mounted as level as the model believes."""

from collections.abc import Mapping, Sequence
from typing import final

import numpy as np
from scipy.spatial.transform import Rotation

from lagnet.effects.effect import Effect, Parameter, Values
from lagnet.effects.excitation import needs_any_motion
from lagnet.effects.inertia.mounting import DOWN, FAR, far_direction
from lagnet.effects.motion import Motion

SMALL = 0.6  # rad: as far as the law made linear about the level base is used
LINEAR = 0.03  # rad: beyond, the law made linear about the level base leaves 5e-4 of the weight
UPSIDE_DOWN = 2.8  # rad
TURN = 3.2  # rad: a base that hangs from a ceiling is turned by π
SHARE = (0.5, 1.5)  # of a large tilt that is already near: its own coefficient would be 1


@final
class GravityTilt(Effect):
    """The base is rotated against the vertical, so that gravity points elsewhere in its frame: r = Y_g(q) Δg."""

    name = "gravity_tilt"
    title = "Tilted base"
    formula = "Y_g(q) (R(θ)ᵀ g − g)"
    parameters = (
        Parameter("theta_1", "θ_1", "rad", "rotation of the base about its first horizontal axis", -TURN, TURN),
        Parameter("theta_2", "θ_2", "rad", "rotation of the base about its second horizontal axis", -TURN, TURN),
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

    def shapes(self, motion: Motion, joint: int | None) -> Sequence[Values]:
        """Level; and where the recorded torque says so, a base mounted on a wall or a ceiling."""
        if motion.recorded is None:
            return ({},)
        direction = motion.remembered("mounting", lambda: self._mounting(motion))
        return ({},) if direction is None else ({}, _turn_to(direction))

    def _mounting(self, motion: Motion) -> np.ndarray | None:
        model, still = motion.bodies, np.zeros_like(motion.q)
        axes = np.linalg.norm(model.gravity) * np.column_stack(level_frame(np.asarray(model.gravity, dtype=float)))
        last = motion.n_dof - 1
        fields = np.stack([model.with_gravity(g).link_regressor(last, motion.q, still, still) for g in axes.T])
        inertia = model.with_gravity(np.zeros(3)).link_regressor(last, motion.q, motion.v, motion.a)
        return far_direction(self.gravity_regressor(motion) @ axes, fields, inertia, motion)

    def columns(self, motion: Motion, joint: int | None, shape: Mapping[str, float]) -> np.ndarray:
        return self.gravity_regressor(motion) @ self.changes(np.asarray(motion.bodies.gravity, dtype=float), shape)

    def changes(self, gravity: np.ndarray, shape: Mapping[str, float]) -> np.ndarray:
        """Change of gravity in the frame of the base per unit of each coefficient, shape (3, k) [m/s²].

        About a large tilt the first is that tilt itself.
        """
        return np.linalg.norm(gravity) * np.column_stack(level_frame(gravity)) @ _changes(shape)

    def changes_near(self, gravity: np.ndarray, values: Mapping[str, float]) -> np.ndarray:
        """As `changes` about the level base, but exact at a tilt: J + (Δg(θ₀) − J θ₀) θ₀ᵀ / θ₀², shape (3, 2)."""
        level, turn = self.changes(gravity, {}), np.array([values["theta_1"], values["theta_2"]])
        left = self.gravity_of(gravity, values) - gravity - level @ turn
        return level + np.outer(left, turn) / max(turn @ turn, 1e-30)

    def bounds(self, shape: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        lower, upper = (np.full(2, SMALL * sign) for sign in (-1.0, 1.0))
        return (np.append(SHARE[0], lower), np.append(SHARE[1], upper)) if shape else (lower, upper)

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        if not shape:
            return {"theta_1": float(coefficients[0]), "theta_2": float(coefficients[1])}
        return _turn_to(DOWN + _changes(shape) @ coefficients)

    def gravity_of(self, gravity: np.ndarray, values: Mapping[str, float]) -> np.ndarray:
        """Gravity in the frame of the tilted base, shape (3,) [m/s²]."""
        return np.linalg.norm(gravity) * np.column_stack(level_frame(gravity)) @ _direction(values)

    def torque(self, motion: Motion, joint: int | None, values: Mapping[str, float]) -> np.ndarray:
        gravity = np.asarray(motion.bodies.gravity, dtype=float)
        return self.gravity_regressor(motion) @ (self.gravity_of(gravity, values) - gravity)

    def remark(self, values: Mapping[str, float]) -> str:
        turned = float(np.hypot(values["theta_1"], values["theta_2"]))
        mounted = "the arm hangs from a ceiling" if turned > UPSIDE_DOWN else "as on a slope or a wall"
        return f"turned by {np.rad2deg(turned):.0f}°: {mounted}" if turned > SMALL else ""

    def excitation(self, motion: Motion, joint: int | None) -> str | None:
        return needs_any_motion(motion)

    def gravity_regressor(self, motion: Motion) -> np.ndarray:
        """Y_g(q), torque per unit of each component of gravity, shape (n, dof, 3)."""
        return motion.remembered("gravity", lambda: motion.bodies.gravity_regressor(motion.q))


def is_large(turn: Mapping[str, float]) -> bool:
    """Whether a tilt is one that is looked for by its direction first."""
    return bool(np.hypot(turn["theta_1"], turn["theta_2"]) > FAR)


def is_bent(turn: Mapping[str, float]) -> bool:
    """Whether what the law made linear about the level base leaves of a tilt, θ²/2 of the weight, may be seen."""
    return bool(np.hypot(turn["theta_1"], turn["theta_2"]) > LINEAR)


def level_frame(gravity: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Two unit axes of the base across gravity and the one against it; x, y and z where gravity points along -z."""
    down = gravity / np.linalg.norm(gravity)
    across = np.eye(3)[0] if abs(down[0]) < 0.9 else np.eye(3)[2]
    first = across - down * (across @ down)
    first /= np.linalg.norm(first)
    return first, np.cross(-down, first), -down


def _direction(turn: Mapping[str, float]) -> np.ndarray:
    """Unit vector of gravity in the level frame after the base was turned, shape (3,)."""
    return Rotation.from_rotvec([-turn["theta_1"], -turn["theta_2"], 0.0]).apply(DOWN)


def _turn_to(direction: np.ndarray) -> Values:
    """The turn about a horizontal axis after which gravity points along a direction of the level frame."""
    x, y, z = direction / np.linalg.norm(direction)
    across = np.hypot(x, y)
    first, second = (-y / across, x / across) if across > 0.0 else (1.0, 0.0)
    angle = np.arctan2(across, -z)
    return {"theta_1": float(angle * first), "theta_2": float(angle * second)}


def _changes(shape: Mapping[str, float]) -> np.ndarray:
    """Change of the direction of gravity in the level frame per unit of each coefficient, shape (3, 2) or (3, 3).

    About the level base, those of the two tilts; about a large tilt, that tilt itself and two turns there.
    """
    if not shape:
        return np.array([[0.0, 1.0], [-1.0, 0.0], [0.0, 0.0]])
    there = _direction(shape)
    first, second, _ = level_frame(there)
    return np.column_stack([there - DOWN, first, second])
