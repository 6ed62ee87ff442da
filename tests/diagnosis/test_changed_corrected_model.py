"""Links that are freed beside a corrected model: what is real is the sum of all its changes."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.free_bodies import with_changed_bodies
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.motion_terms import Rest
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.random_arm import random_arm

EXACT = 1e-9
SLOW = np.full(3, 0.01)
LOAD = {"m": 2.0, "cx": 0.0, "cy": 0.05, "cz": 0.1}
INERTIA = {"Ixx": 0.03, "Ixy": 0.0, "Iyy": 0.03, "Ixz": 0.0, "Iyz": 0.0, "Izz": 0.02}


@pytest.fixture(scope="module")
def arm():
    return random_arm(3, seed=5, kinds=("revolute",))


@pytest.fixture(scope="module")
def samples():
    return [np.random.default_rng(k).uniform(-1.0, 1.0, (30, 3)) for k in range(3)]


def twice_as_heavy(arm) -> np.ndarray:
    return arm.inertial_parameters()


def of_layer(arm) -> CorrectedModel:
    layer = IdentifiedLayer(twice_as_heavy(arm), (), np.zeros(0), Rest(SLOW, np.zeros(3)))
    return CorrectedModel(arm, (), SLOW, identified=layer)


def in_place_of_names(arm) -> CorrectedModel:
    layer = IdentifiedLayer(twice_as_heavy(arm), (), np.zeros(0), Rest(SLOW, np.zeros(3)))
    return CorrectedModel(arm, (), SLOW, instead=layer)


def of_a_load(arm) -> CorrectedModel:
    return CorrectedModel(arm, (NamedEffect("payload", None, LOAD | INERTIA),), SLOW)


@pytest.mark.parametrize("corrected", [of_layer, in_place_of_names, of_a_load])
def test_a_change_that_is_real_only_beside_the_others_is_taken(arm, samples, corrected) -> None:
    model = corrected(arm)
    target = 0.5 * arm.inertial_parameters()  # less than the nominal bodies have: these alone could not lose it twice
    change = target - model.bodies().inertial_parameters()
    changed = with_changed_bodies(model, change)
    np.testing.assert_allclose(changed.bodies().inertial_parameters(), target, atol=EXACT)
    expected = arm.with_inertial_parameters(target).inverse_dynamics(*samples)
    np.testing.assert_allclose(changed.inverse_dynamics(*samples), expected, atol=1e3 * EXACT)


def test_friction_of_the_corrected_model_stays(arm, samples) -> None:
    friction = NamedEffect("viscous_friction", 1, {"Fv": 0.7})
    model = CorrectedModel(arm, (friction,), SLOW)
    changed = with_changed_bodies(model, 0.1 * arm.inertial_parameters())
    before, after = (m.residual_torque(*samples) for m in (model, changed))
    np.testing.assert_allclose(after, before, atol=EXACT)
