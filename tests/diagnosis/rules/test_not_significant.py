"""What the error of another law's form leaves open is not claimed; a small effect that is there stays."""

from __future__ import annotations

import numpy as np
from tests.diagnosis.posed import pose

from lagnet.diagnosis.rules.apply import apply_rules
from lagnet.diagnosis.rules.negligible_torque import NegligibleTorque
from lagnet.diagnosis.rules.not_significant import NotSignificant
from lagnet.effects.catalogue import effect_named

JOINT = 1


def told(arm, real, *names: str):
    """Names at the joint when exactly these are fitted, and those of them that are sure; before and after."""
    posed = pose(arm, real.record(1), real.record(2))
    before = apply_rules([NegligibleTorque()], posed.candidate(posed.select({JOINT: names}))).candidate
    pairs = zip(before.effects, before.refit.intervals, strict=True)
    assert all(effect_named(e.effect).is_determined(i) for e, i in pairs)  # by the scatter of blocks alone
    after = apply_rules([NegligibleTorque(), NotSignificant()], before).candidate
    return {e.effect for e in before.effects}, {e.effect for e in after.effects}


def test_a_shadow_of_another_law_goes(plant, arm, at) -> None:
    real = plant(at(JOINT, lambda q, v, a, t: 6.0 * np.sign(v) * np.abs(v) ** 0.7))
    before, after = told(arm, real, "viscous_friction", "torque_gain")
    assert before == {"viscous_friction", "torque_gain"}
    assert after == {"viscous_friction"}


def test_a_small_effect_that_is_there_stays(plant, arm, at) -> None:
    real = plant(at(JOINT, lambda q, v, a, t: 6.0 * v + 0.25 * np.tanh(v / 1e-3)))
    both = {"viscous_friction", "coulomb_friction"}
    assert told(arm, real, *both) == (both, both)
