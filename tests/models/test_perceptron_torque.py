"""Torque of the perceptron form, written out by hand, is what its energies give; so are its network's two passes."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from lagnet.models.features import fit_features
from lagnet.models.kinds import ModelSpec, draw
from lagnet.models.lagrangians import euler_lagrange
from lagnet.models.lagrangians.conservative import Conservative
from lagnet.models.lagrangians.perceptron_delan import COUPLINGS, PerceptronDelanSettings
from lagnet.models.networks import ACTIVATIONS, make_network
from lagnet.models.scales import fit_scales

pytestmark = pytest.mark.slow

IDENTITY = 1e-10  # float64 rounding of some hundred operations on numbers of order 1 to 100
TYPES = ("continuous", "prismatic", "revolute")


@pytest.mark.parametrize("coupling", COUPLINGS)
@pytest.mark.parametrize("activation", ACTIVATIONS)
def test_torque_by_hand_is_that_of_the_energies(activation, coupling):
    rng = np.random.default_rng(0)
    q, v, a, tau = rng.normal(size=(4, 40, 3))
    settings = PerceptronDelanSettings(hidden=(8, 6), activation=activation, coupling=coupling)
    spec = ModelSpec("delan-perceptron", settings, ("a", "b", "c"), fit_features(q, TYPES), fit_scales(v, a, tau))
    with jax.enable_x64(True):
        model = draw(spec, jax.random.key(1))
        assert isinstance(model, Conservative)
        given = [jnp.asarray(x) for x in (q, v, a)]
        by_hand = jax.vmap(model.inverse_dynamics)(*given)
        wanted = jax.vmap(lambda *s: euler_lagrange.inverse_dynamics(model.lagrangian, *s))(*given)
    np.testing.assert_allclose(by_hand, wanted, atol=IDENTITY)
    assert np.abs(wanted).max() > 0.1


@pytest.mark.parametrize("activation", ACTIVATIONS)
def test_a_network_gives_both_of_its_jacobian_products(activation):
    with jax.enable_x64(True):
        network = make_network(jax.random.key(0), (0, 1, 2), (0, 1), (5, 4), activation, hidden_degrees=(0, 1))
        x, direction, wanted = (jax.random.normal(jax.random.key(k), (n,)) for k, n in ((1, 3), (2, 3), (3, 2)))
        found, along, back = network.linearised(x)
        same, change = jax.jvp(network, (x,), (direction,))
        pulled = jax.vjp(network, x)[1](wanted)[0]
        pairs = [(found, same), (along(direction), change), (back(wanted), pulled)]
        for ours, theirs in pairs:
            np.testing.assert_allclose(ours, theirs, atol=IDENTITY)
