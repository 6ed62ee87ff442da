"""An ε that is exactly zero adds nothing, whatever the size of the batch."""

from __future__ import annotations

import jax
import numpy as np
import pytest

from lagnet.models.features import fit_features
from lagnet.models.kinds import AugmentedSettings, ModelSpec, draw
from lagnet.models.lagrangians.delan import DelanSettings
from lagnet.models.learned_model import CHUNK, LearnedModel
from lagnet.models.scales import fit_scales

IDENTITY = 1e-9  # float64 rounding of about a thousand operations on numbers of order 1 to 100


@pytest.mark.slow
def test_a_silent_epsilon_adds_nothing_to_a_full_batch():
    q, v, a, tau = np.random.default_rng(0).normal(size=(4, CHUNK, 2))
    settings = AugmentedSettings(mechanics_settings=DelanSettings(rank=3, potential_rank=3))
    scales = fit_scales(v, a, tau)
    spec = ModelSpec("delan-ffnn", settings, ("a", "b"), fit_features(q, ("continuous",) * 2), scales)
    model = LearnedModel(spec, draw(spec, jax.random.key(0)))
    terms = np.einsum("nij,nj->ni", model.mass_matrix(q), a) + model.coriolis_torque(q, v) + model.gravity_torque(q)
    np.testing.assert_allclose(model.inverse_dynamics(q, v, a), terms, atol=IDENTITY)
