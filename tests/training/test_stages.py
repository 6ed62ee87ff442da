"""Training in stages: mechanics are those of a model without ε, and ε is kept where held-out torque bears it out."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.training.test_learned_training import SHORT, TINY, pendulum

from lagnet.models.kinds import AugmentedSettings
from lagnet.models.residuals.augmented import Augmented
from lagnet.models.residuals.torque_network import TorqueNetworkSettings
from lagnet.training.held_out_share import shares
from lagnet.training.train import train

pytestmark = pytest.mark.slow

SETTINGS = AugmentedSettings(mechanics_settings=TINY, residual=TorqueNetworkSettings(hidden=(8,)))
NOISE = 0.3  # N m, white: nothing that an ε could know of


def noisy(friction: float) -> Any:
    run = pendulum(2000)
    assert run.v is not None
    noise = NOISE * np.random.default_rng(5).normal(size=run.q.shape)
    return replace(run, tau=run.tau + friction * run.v + noise)


@pytest.fixture(scope="module")
def calm() -> Any:
    return train([noisy(0.0)], "delan-ffnn", settings=SETTINGS, training=SHORT)


def test_mechanics_are_those_of_a_model_without_epsilon_to_the_bit(calm):
    alone = train([noisy(0.0)], "delan", settings=TINY, training=SHORT)
    q = np.linspace(-3, 3, 7)[:, None]
    for call in ("mass_matrix", "gravity_torque"):
        np.testing.assert_array_equal(getattr(calm.model, call)(q), getattr(alone.model, call)(q))
    assert calm.stats["steps"] > alone.stats["steps"] == SHORT.steps


def test_an_epsilon_that_learned_noise_is_silenced(calm):
    dynamics = calm.model.dynamics
    assert isinstance(dynamics, Augmented)
    q = np.linspace(-3, 3, 7)[:, None]
    assert calm.stats["epsilon_shares"] == [0.0]
    assert not calm.model.residual_torque(q, q, q).any()


def test_an_epsilon_that_found_friction_stays():
    found = train([noisy(2.0)], "delan-ffnn", settings=SETTINGS, training=SHORT)
    q, v, a = np.random.default_rng(1).normal(size=(3, 500, 1))
    assert found.stats["epsilon_shares"][0] > 0.9
    error = found.model.residual_torque(q, v, a) - 2.0 * v
    assert np.sqrt(np.mean(error**2)) < 0.25 * 2.0
    floor = NOISE**2 / noisy(2.0).tau.var()
    assert found.stats["held_out_error"][0] < 2.0 * floor


def test_half_of_an_epsilon_twice_too_large_is_kept_and_nothing_of_chance():
    rng = np.random.default_rng(0)
    left = rng.normal(size=(4000, 3))
    other = rng.normal(size=left.shape)
    epsilon = np.stack([2.0 * left[:, 0], other[:, 1], -left[:, 2]], axis=1)
    np.testing.assert_allclose(shares(left, epsilon), [0.5, 0.0, 0.0], atol=1e-12)


def test_a_silent_epsilon_has_no_share():
    assert not shares(np.ones((50, 2)), np.zeros((50, 2))).any()
