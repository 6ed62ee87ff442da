"""Contact force: for a while, a point of the last link pushes against something that the model does not know of."""

from collections.abc import Mapping
from typing import final

import numpy as np

from lagnet.effects.effect import Effect, Parameter, Values
from lagnet.effects.excitation import needs_any_motion
from lagnet.effects.motion import Motion

FORCE = ("Fx", "Fy", "Fz")
POINT = ("px", "py", "pz")
FARTHEST = 0.5  # [m] that the point may lie off the last joint, along each axis
WITHIN = 0.99 * FARTHEST  # [m] up to which a fit has not run into that bound


@final
class ContactForce(Effect):
    """A point of the last link pushes on its surroundings, always the same way: r = J(q, p)ᵀ F, F in the base."""

    name = "contact_force"
    title = "Contact force"
    formula = "J(q, p)ᵀ F on an interval"
    parameters = (
        *(Parameter(n, f"F_{n[1]}", "N", f"push on the surroundings along {n[1]} of the base") for n in FORCE),
        *(
            Parameter(
                n, f"p_{n[1]}", "m", f"where it pushes, along {n[1]} of the last joint's frame", -FARTHEST, FARTHEST
            )
            for n in POINT
        ),
    )
    whole_arm = True
    reaches_all = True
    is_transient = True
    stage = "body"
    needs_bodies = True
    shown_by = "motion before and after the contact, with the same load"
    confused_with = ("payload",)
    absent = tuple((n, 0.0) for n in FORCE)
    source = "deluca2005"

    def columns(self, motion: Motion, joint: int | None, shape: Mapping[str, float]) -> np.ndarray:
        wrench = _wrench(motion)
        return -wrench[:, :, :3] - wrench[:, :, 3:] @ _cross(_arms(motion, shape))

    def bounds(self, shape: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        return np.full(3, -np.inf), np.full(3, np.inf)

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        point = {n: float(shape.get(n, 0.0)) for n in POINT}
        return {**dict(zip(FORCE, map(float, coefficients), strict=True)), **point}

    def torque(self, motion: Motion, joint: int | None, values: Mapping[str, float]) -> np.ndarray:
        return self.columns(motion, joint, values) @ np.array([values[n] for n in FORCE])

    def relaxed(self, motion: Motion) -> np.ndarray:
        """The law with all products p_i F_k free, hence linear: columns of F, then of p_i F_k, shape (n, dof, 12)."""
        wrench = _wrench(motion)
        axes = motion.remembered("last axes", lambda: motion.robot.orientation(motion.q))
        moments = [-wrench[:, :, 3:] @ _cross(axes[:, :, i]) for i in range(3)]
        return np.concatenate([-wrench[:, :, :3], *moments], axis=2)

    def nearest(self, coefficients: np.ndarray) -> Values:
        """Force and point of fitted coefficients (12,) of `relaxed`."""
        force, products = coefficients[:3], np.reshape(coefficients[3:], (3, 3))
        point = np.clip(products @ force / max(float(force @ force), 1e-300), -FARTHEST, FARTHEST)
        return self.values(force, dict(zip(POINT, map(float, point), strict=True)))

    def is_determined(self, intervals: Mapping[str, tuple[float, float]]) -> bool:
        """Whether some component of the force is not zero, and the point lies within reach: a push needs both.

        A point pressed to the edge of what is asked stands for a moment without a force.
        """
        within = all(abs(sum(intervals[n])) < 2.0 * WITHIN for n in POINT)
        return within and super().is_determined(intervals)

    def excitation(self, motion: Motion, joint: int | None) -> str | None:
        return needs_any_motion(motion)


def _wrench(motion: Motion) -> np.ndarray:
    """Torque per unit of a wrench on the last link, at its joint's origin, shape (n, dof, 6)."""
    last = motion.n_dof - 1
    return motion.remembered("last wrench", lambda: motion.robot.wrench_regressor(motion.q, last))


def _arms(motion: Motion, point: Mapping[str, float]) -> np.ndarray:
    """Vector from the last joint to the point of contact in the axes of the base, shape (n, 3) [m]."""
    axes = motion.remembered("last axes", lambda: motion.robot.orientation(motion.q))
    return axes @ np.array([point.get(n, 0.0) for n in POINT])


def _cross(arms: np.ndarray) -> np.ndarray:
    """Matrices that turn a force into its moment, arm × force, shape (n, 3, 3)."""
    x, y, z = arms.T
    zero = np.zeros_like(x)
    return np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)
