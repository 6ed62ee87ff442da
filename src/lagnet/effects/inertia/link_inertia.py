"""Link inertia: a link whose mass, centre of mass or inertia the model has wrong."""

from collections.abc import Mapping
from typing import final

import numpy as np

from lagnet.effects.effect import LinearEffect, Parameter
from lagnet.effects.excitation import needs_any_motion
from lagnet.effects.motion import Motion

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

    The last link is left to `payload`, which is the same torque under the name that users expect.
    """

    name = "link_inertia"
    title = "Wrong inertial parameters of a link"
    formula = "Y_k(q, v, a) · Δπ_k"
    parameters = tuple(Parameter(n, f"Δ{n[1:]}", u, m) for n, u, m in zip(NAMES, UNITS, MEANINGS, strict=True))
    reaches_all = True
    needs_bodies = True
    stage = "body"
    plain_terms = 3
    shown_by = "all joints moving at once, with strong accelerations and in many poses"
    confused_with = ("payload", "rotor_inertia", "gravity_tilt", "torque_gain")
    absent = tuple((n, 0.0) for n in NAMES)
    is_body = True
    changes_link = True
    source = "gautier1990"

    def regressor(self, motion: Motion, joint: int) -> np.ndarray:
        return motion.link_regressor(joint)

    def torque(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        return motion.body_torque(joint, np.array([values[p.name] for p in self.parameters]))

    def plausible(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> bool:
        return bool(np.all(np.isfinite(coefficients)))

    def excitation(self, motion: Motion, joint: int) -> str | None:
        if joint == motion.n_dof - 1:
            return "a change of the last link is a payload"
        return needs_any_motion(motion)
