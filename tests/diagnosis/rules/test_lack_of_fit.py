"""A name is held to the joints where it helps, and to a tenth of a disturbance that stands beside it there."""

from __future__ import annotations

from dataclasses import replace

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


@pytest.mark.parametrize(("power", "stays"), [(0.5, True), (6.0, True), (25.0, False)])
def test_a_tenth_of_a_disturbance_is_asked_for(plant, arm, at, power, stays) -> None:
    real = plant(at(1, disturbed(power, np.random.default_rng(5))))
    posed = pose(arm, real.record(1), real.record(2))
    candidate = posed.candidate(posed.select({1: ["viscous_friction"]}))
    assert left_shares(candidate, "fit")[1] == pytest.approx(power / (1.0 + power), abs=0.1)
    assert (LackOfFit().rejected(candidate) == ()) == stays


def late(v, distance, rate=100.0):
    """s(v) as it is reached after a reversal, over a distance: z with ż = (v − |v| z) / distance."""
    z = np.zeros(len(v))
    for k in range(1, len(v)):
        decay = np.exp(-abs(v[k]) / rate / distance)
        z[k] = decay * z[k - 1] + (1.0 - decay) * np.sign(v[k])
    return z


@pytest.mark.parametrize(
    ("beside", "stays"),
    [(lambda q, v: 2.0 * (late(v, 0.02) - np.sign(v)), True), (lambda q, v: np.sin(9.0 * q), False)],
)
def test_friction_that_the_identified_layer_bears_out_stays_beside_what_the_layer_explains(
    plant, arm, at, beside, stays
) -> None:
    real = plant(at(1, lambda q, v, a, body: 2.0 * np.sign(v) + 2.0 * beside(q, v)))
    posed = pose(arm, real.record(1), real.record(2))
    candidate = posed.candidate(posed.select({1: ["coulomb_friction"]}))
    assert left_shares(candidate, "holdout")[1] > LackOfFit().much
    assert (LackOfFit().rejected(candidate) == ()) == stays
    assert LackOfFit(borne_out=np.inf).rejected(candidate) != ()


@pytest.mark.parametrize(("times", "stays"), [(5.0, False), (8.0, True)])
def test_an_effect_outgrows_the_known_error_of_the_nominal_model(plant, arm, at, times, stays) -> None:
    real = plant(at(1, lambda q, v, a, body: 4.0 * v))
    posed = pose(arm, real.record(1), real.record(2))
    candidate = posed.candidate(posed.select({1: ["viscous_friction"]}))
    assert LackOfFit().rejected(candidate) == ()
    explained = candidate.power("holdout", ()) - candidate.power("holdout")
    known = replace(candidate, problem=replace(posed.problem, missed=np.sqrt(np.maximum(explained, 1e-9) / times)))
    assert (LackOfFit().rejected(known) == ()) == stays
