"""One sample in plain NumPy gets the torque that the model gives it in a compiled batch."""

from __future__ import annotations

import jax
import numpy as np
import pytest

from lagnet.models.features import fit_features
from lagnet.models.kinds import ModelSpec, draw
from lagnet.models.lagrangians.delan import DelanSettings
from lagnet.models.lagrangians.perceptron_delan import COUPLINGS, PerceptronDelanSettings
from lagnet.models.learned_model import LearnedModel
from lagnet.models.networks import ACTIVATIONS
from lagnet.models.one_sample import BENDS, OneSample
from lagnet.models.scales import fit_scales

pytestmark = pytest.mark.slow

IDENTITY = 1e-10  # float64 rounding of some hundred operations on numbers of order 1 to 100
SINGLE = 1e-5  # of the largest torque: float32 rounding of the same
TYPES = ("prismatic", "continuous", "prismatic", "revolute")
DOF = len(TYPES)


def model_of(settings, kind="delan-perceptron", precision="double") -> LearnedModel:
    q, v, a, tau = np.random.default_rng(0).normal(size=(4, 60, DOF))
    features, scales = fit_features(q, TYPES), fit_scales(v, a, 10.0 * tau)
    spec = ModelSpec(kind, settings, tuple("abcd"), features, scales)
    return LearnedModel(spec, draw(spec, jax.random.key(1)), precision=precision)


def one_by_one(model: LearnedModel, motion: np.ndarray) -> np.ndarray:
    return np.concatenate([model.inverse_dynamics(*motion[:, i : i + 1]) for i in range(motion.shape[1])])


def speaks_numpy(model: LearnedModel) -> bool:
    return isinstance(model._functions["inverse_dynamics", True], OneSample)


@pytest.fixture(scope="module")
def motion() -> np.ndarray:
    return np.random.default_rng(2).normal(size=(3, 7, DOF)) * np.array([4.0, 3.0, 20.0])[:, None, None]


@pytest.mark.parametrize("hidden", [(5,), (8, 6), (7, 5, 6)])
@pytest.mark.parametrize("coupling", COUPLINGS)
@pytest.mark.parametrize("activation", ACTIVATIONS)
def test_alone_and_together_are_the_same(activation, coupling, hidden, motion):
    model = model_of(PerceptronDelanSettings(hidden, activation, coupling))
    together, alone = model.inverse_dynamics(*motion), one_by_one(model, motion)
    assert speaks_numpy(model)
    np.testing.assert_allclose(alone, together, atol=IDENTITY)
    assert np.abs(together).max() > 1.0


def test_a_sample_in_single_precision_is_computed_in_it(motion):
    settings = PerceptronDelanSettings(hidden=(8, 6))
    exact = model_of(settings).inverse_dynamics(*motion)
    single = model_of(settings, precision="single")
    near = one_by_one(single, motion)
    assert speaks_numpy(single)
    assert near.dtype == np.float64
    np.testing.assert_array_equal(near, near.astype(np.float32))
    assert 0 < np.abs(near - exact).max() < SINGLE * np.abs(exact).max()


def test_outputs_far_out_neither_overflow_nor_warn(motion):
    model = model_of(PerceptronDelanSettings(hidden=(5,)))
    with jax.enable_x64(True):
        far = LearnedModel(model.spec, jax.tree.map(lambda x: 1e4 * x, model.dynamics))
    together = far.inverse_dynamics(*motion)
    assert np.all(np.isfinite(together))
    np.testing.assert_allclose(one_by_one(far, motion), together, rtol=1e-9, atol=1e-9 * np.abs(together).max())


def test_every_activation_has_its_numpy_side():
    assert set(BENDS) == set(ACTIVATIONS)


def test_a_model_of_another_form_goes_its_own_way(motion):
    model = model_of(DelanSettings(rank=3, potential_rank=3), "delan")
    np.testing.assert_allclose(one_by_one(model, motion), model.inverse_dynamics(*motion), atol=IDENTITY)
    assert not speaks_numpy(model)
