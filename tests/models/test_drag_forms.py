"""Every ε of drag and friction takes energy out, is odd in v, does not see acceleration, and survives being saved."""

from __future__ import annotations

import jax
import numpy as np
import pytest

from lagnet.models.features import fit_features
from lagnet.models.files.saving import load_model
from lagnet.models.kinds import AugmentedSettings, ModelSpec, draw
from lagnet.models.lagrangians.delan import DelanSettings
from lagnet.models.learned_model import LearnedModel
from lagnet.models.residuals.body_drag import BodyDragSettings
from lagnet.models.residuals.dissipation import DissipationSettings
from lagnet.models.scales import fit_scales

pytestmark = pytest.mark.slow

IDENTITY = 1e-9  # float64 rounding of about a thousand operations on numbers of order 1 to 100
SMALL = DelanSettings(rank=3, potential_rank=3)
FORMS = {"dissipation": DissipationSettings(rank=4), "body-drag": BodyDragSettings(2)}
TYPES = ("continuous", "prismatic", "revolute")


@pytest.fixture(scope="module")
def motion() -> tuple[np.ndarray, ...]:
    rng = np.random.default_rng(3)
    return tuple(rng.normal(size=(40, 3)) for _ in range(3))


@pytest.fixture(scope="module", params=FORMS)
def model(request) -> LearnedModel:
    q, v, a, tau = np.random.default_rng(0).normal(size=(4, 60, 3))
    settings = AugmentedSettings(form=request.param, residual=FORMS[request.param], mechanics_settings=SMALL)
    spec = ModelSpec("delan-ffnn", settings, ("a", "b", "c"), fit_features(q, TYPES), fit_scales(v, a, tau))
    return LearnedModel(spec, draw(spec, jax.random.key(1)))


def test_motion_pays_for_it(model, motion):
    q, v, a = motion
    power = np.sum(v * model.residual_torque(q, v, a), axis=1)
    assert power.min() > 0


def test_it_is_odd_in_velocity_and_does_not_see_acceleration(model, motion):
    q, v, a = motion
    found = model.residual_torque(q, v, a)
    np.testing.assert_allclose(found, -model.residual_torque(q, -v, 0 * a), atol=IDENTITY)
    np.testing.assert_allclose(model.residual_torque(q, 0 * v, a), 0.0, atol=IDENTITY)


def test_a_saved_model_comes_back_the_same(model, motion, tmp_path):
    again = load_model(model.save(tmp_path / "model"))
    assert again.spec == model.spec
    np.testing.assert_array_equal(again.inverse_dynamics(*motion), model.inverse_dynamics(*motion))
