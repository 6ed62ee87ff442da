"""Calls of a learned model: in whatever number samples come and in whatever precision, they get the same torque."""

from __future__ import annotations

import jax
import numpy as np
import pytest

from lagnet.errors import ModelError
from lagnet.models.features import fit_features
from lagnet.models.kinds import ModelSpec, draw
from lagnet.models.lagrangians.perceptron_delan import PerceptronDelanSettings
from lagnet.models.learned_model import CHUNK, LearnedModel
from lagnet.models.scales import fit_scales

pytestmark = pytest.mark.xdist_group("learned_calls")  # what they share is made once

IDENTITY = 1e-9  # float64 rounding of about a thousand operations on numbers of order 1 to 100
SINGLE = 1e-5  # of the largest torque: float32 rounding of the same


@pytest.fixture(scope="module")
def motion() -> tuple[np.ndarray, ...]:
    rng = np.random.default_rng(3)
    return tuple(rng.normal(size=(2 * CHUNK + 77, 2)) for _ in range(3))


@pytest.fixture(scope="module")
def model() -> LearnedModel:
    q, v, a, tau = np.random.default_rng(0).normal(size=(4, 60, 2))
    features, scales = fit_features(q, ("continuous", "revolute")), fit_scales(v, a, tau)
    spec = ModelSpec("delan-perceptron", PerceptronDelanSettings(hidden=(8, 8)), ("a", "b"), features, scales)
    return LearnedModel(spec, draw(spec, jax.random.key(1)))


def test_many_samples_get_what_each_gets_alone(model, motion):
    together = model.inverse_dynamics(*motion)
    assert together.shape == motion[0].shape
    for row in (0, CHUNK - 1, CHUNK, len(together) - 1):
        alone = model.inverse_dynamics(*(x[row : row + 1] for x in motion))
        np.testing.assert_allclose(together[row : row + 1], alone, atol=IDENTITY)


def test_single_precision_is_near_and_speaks_float64(model, motion):
    exact, near = model.inverse_dynamics(*motion), model.in_single_precision().inverse_dynamics(*motion)
    assert near.dtype == np.float64
    assert 0 < np.abs(near - exact).max() < SINGLE * np.abs(exact).max()


def test_what_a_caller_is_given_is_his_to_change(model, motion):
    for rows in (slice(0, 1), slice(0, 5), slice(0, CHUNK)):
        found = model.inverse_dynamics(*(x[rows] for x in motion))
        found += 1.0


def test_an_unknown_precision_is_refused(model):
    with pytest.raises(ModelError, match="double"):
        LearnedModel(model.spec, model.dynamics, precision="half")
