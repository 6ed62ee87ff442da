"""Encoder offset: a joint angle recorded with a constant error."""

from collections.abc import Mapping
from typing import final

import numpy as np

from lagnet.effects.effect import LinearEffect, Parameter
from lagnet.effects.excitation import needs_any_motion
from lagnet.effects.motion import Motion
from lagnet.effects.shifted import shifted_torque
from lagnet.effects.slopes import per_angle


@final
class EncoderOffset(LinearEffect):
    """The arm stands elsewhere than its encoder says, at q + δ: r = τ_model(q + δ) − τ_model(q)."""

    name = "encoder_offset"
    title = "Encoder offset"
    formula = "τ(q + δ) − τ(q)"
    parameters = (Parameter("delta", "δ", "rad", "true position less recorded position", -0.5, 0.5),)
    reaches_all = True
    stage = "body"
    shown_by = "gravity-loaded poses over a wide range of all joints"
    confused_with = ("gravity_tilt", "link_inertia", "payload", "torque_offset")
    source = "swevers2007"

    def regressor(self, motion: Motion, joint: int) -> np.ndarray:
        return per_angle(motion, joint)[..., None]

    def torque(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        if values["delta"] == 0.0:
            return np.zeros_like(motion.load)
        return shifted_torque(motion, joint, np.full(motion.time.size, values["delta"]))

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_any_motion(motion)
