"""A name is held to the joints where it helps, and to half of a disturbance that stands beside it there."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d
from tests.diagnosis.posed import pose

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.rules.lack_of_fit import LackOfFit, left_shares

MASS = 1.5  # [kg]
CORRELATED = 15  # samples over which a disturbance holds
LIMIT = 1.0  # [N m] that the sensor of one joint cannot exceed in one direction, which is in no catalogue


@pytest.mark.slow
def test_a_sensor_that_fails_at_one_joint_does_not_hide_a_payload(plant, arm, at) -> None:
    loaded = arm.with_payload(MASS, np.array([0.05, 0.08, 0.15]), 0.006 * np.eye(3))
    real = plant(at(0, lambda q, v, a, body: np.minimum(body, LIMIT) - body), robot=loaded)
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    payload = next(e for e in result.effects if e.effect == "payload")
    assert payload.value("m") == pytest.approx(MASS, rel=0.1)
    left = {u.joint: u.above_noise for u in result.verdict.unexplained}
    assert left[arm.joints[0]]


def disturbed(power, chance):
    """Viscous friction beside a torque of so many times its power that follows nothing: another in each recording."""

    def torque(q, v, a, body):
        friction, rest = 4.0 * v, gaussian_filter1d(chance.standard_normal(len(v)), CORRELATED)
        return friction + np.sqrt(power) * friction.std() / rest.std() * rest

    return torque


@pytest.mark.parametrize(("power", "stays"), [(0.5, True), (1.5, True), (4.0, False)])
def test_half_of_a_disturbance_is_asked_for(plant, arm, at, power, stays) -> None:
    real = plant(at(1, disturbed(power, np.random.default_rng(5))))
    posed = pose(arm, real.record(1), real.record(2))
    candidate = posed.candidate(posed.select({1: ["viscous_friction"]}))
    assert left_shares(candidate, "fit")[1] == pytest.approx(power / (1.0 + power), abs=0.1)
    assert (LackOfFit().rejected(candidate) == ()) == stays
