"""Bodies and gravity changed together give the torque of an arm that has both written into it."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.model import CorrectedModel, NamedEffect
from lagnet.rigid_body.robot import load_description

IDENTITY = 1e-9  # rounding in float64
PAYLOAD = {"m": 1.5, "cx": 0.02, "cy": -0.03, "cz": 0.08} | dict.fromkeys(("Ixx", "Iyy", "Izz"), 0.01)
PAYLOAD |= dict.fromkeys(("Ixy", "Ixz", "Iyz"), 0.0)
CHANGE = effect_named("link_inertia").from_coordinates(np.array([0.4, 0.02, -0.01, 0.03, 2e-3, 0, 3e-3, 0, 0, 1e-3]))
TILT = NamedEffect("gravity_tilt", None, {"theta_1": 0.2, "theta_2": -0.1})
BODIES = (NamedEffect("payload", None, PAYLOAD), NamedEffect("link_inertia", 2, CHANGE))
SLOW = np.full(6, 0.02)


@pytest.fixture(scope="module")
def ur5():
    return load_description("ur5")


@pytest.fixture(scope="module")
def samples():
    rng = np.random.default_rng(4)
    return [rng.uniform(-2.0, 2.0, (30, 6)) for _ in range(3)]


@pytest.mark.parametrize("order", [(TILT, *BODIES), (*BODIES, TILT)])
def test_tilt_and_bodies_together_are_those_written_into_the_arm(ur5, samples, order) -> None:
    model = CorrectedModel(ur5, order, SLOW)
    expected = model.bodies().inverse_dynamics(*samples)
    np.testing.assert_allclose(model.inverse_dynamics(*samples), expected, rtol=0, atol=1e3 * IDENTITY)


def test_the_part_that_only_both_have_is_no_rounding(ur5, samples) -> None:
    alone = [CorrectedModel(ur5, part, SLOW).inverse_dynamics(*samples) for part in ((TILT,), BODIES, ())]
    together = CorrectedModel(ur5, (TILT, *BODIES), SLOW).inverse_dynamics(*samples)
    assert np.max(np.abs(together - (alone[0] + alone[1] - alone[2]))) > 0.1


@pytest.mark.parametrize(("first", "second"), [((TILT,), BODIES), (BODIES, (TILT,))])
def test_calibrated_and_then_diagnosed_again_is_the_same_arm(ur5, samples, first, second) -> None:
    model = CorrectedModel(CorrectedModel(ur5, first, SLOW), second, SLOW)
    expected = CorrectedModel(ur5, (*first, *second), SLOW).bodies().inverse_dynamics(*samples)
    np.testing.assert_allclose(model.inverse_dynamics(*samples), expected, rtol=0, atol=1e3 * IDENTITY)
    np.testing.assert_allclose(model.gravity, CorrectedModel(ur5, (TILT,), SLOW).bodies().gravity, atol=IDENTITY)


def test_a_body_that_is_carried_for_a_while_weighs_in_the_tilted_field_then_and_in_its_recording(ur5) -> None:
    """Inside the interval the arm is one with all of it written into it, before and after one without the load."""
    time = 0.01 * np.arange(60)
    q, v, a = (np.random.default_rng(k).uniform(-2.0, 2.0, (60, 6)) for k in range(3))
    carried = NamedEffect("payload", None, PAYLOAD, (time[20], time[40]), 1)
    model = CorrectedModel(ur5, (TILT, carried), SLOW, recording=1)
    elsewhere = CorrectedModel(ur5, (TILT, carried), SLOW, recording=0)
    with_it, without = (CorrectedModel(ur5, e, SLOW).bodies() for e in ((TILT, BODIES[0]), (TILT,)))
    inside = ((time >= time[20]) & (time <= time[40]))[:, None]
    expected = np.where(inside, with_it.inverse_dynamics(q, v, a), without.inverse_dynamics(q, v, a))
    exact = {"rtol": 0, "atol": 1e3 * IDENTITY}
    np.testing.assert_allclose(model.torque_along(time, q, v, a), expected, **exact)
    np.testing.assert_allclose(elsewhere.torque_along(time, q, v, a), without.inverse_dynamics(q, v, a), **exact)
