"""Load-dependent friction: dry friction that grows with the torque through the gear."""

from typing import final

import numpy as np

from lagnet.effects.effect import LinearEffect, Parameter
from lagnet.effects.excitation import needs_both_directions, needs_varying_load
from lagnet.effects.motion import Motion


@final
class LoadDependentFriction(LinearEffect):
    """Teeth pressed together harder rub harder: r = K |τ_load| s(v)."""

    name = "load_dependent_friction"
    title = "Load-dependent friction"
    formula = "K |τ_load| s(v)"
    parameters = (Parameter("K", "K", "–", "friction torque per torque carried", lower=0.0, upper=1.0),)
    plain_terms = 3
    shown_by = "motion in both directions under loads that vary, for instance at several inclinations of the link"
    confused_with = ("coulomb_friction",)
    is_friction = True
    is_dry_friction = True
    uses_load = True
    source = "bittencourt2012"

    def regressor(self, motion: Motion, joint: int) -> np.ndarray:
        return (np.abs(motion.load[:, joint]) * motion.direction(joint))[:, None]

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_both_directions(motion, joint) or needs_varying_load(motion, joint)
