"""How joint positions enter: which features products of many joints may be made of."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from lagnet.models.features import fit_features
from lagnet.models.kinds import ModelSpec, draw, settings_class
from lagnet.models.learned_model import LearnedModel
from lagnet.models.scales import fit_scales

NARROW = 0.4  # rad either side: standardised cosines of such a joint reach far beyond their mean
NEAR = 3e3  # times its variance: 170 here, and 850,000 when features are standardised


def _drawn(q: np.ndarray, types: tuple[str, ...]) -> LearnedModel:
    v, a, tau = np.random.default_rng(1).normal(size=(3, *q.shape))
    names = tuple(f"joint_{i}" for i in range(q.shape[1]))
    spec = ModelSpec("delan", settings_class("delan")(), names, fit_features(q, types), fit_scales(v, a, tau))
    return LearnedModel(spec, draw(spec, jax.random.key(0)))


def test_features_on_the_circle_never_pass_one():
    q = np.random.default_rng(0).uniform(-NARROW, NARROW, (200, 2))
    with jax.enable_x64(True):
        turned = jax.vmap(fit_features(q, ("revolute", "revolute")).on_circle)(jnp.asarray(q))
    assert np.abs(turned).max() <= 1.0


def test_a_sliding_joint_keeps_its_standard_size():
    features = fit_features(np.random.default_rng(0).uniform(3, 4, (200, 2)), ("prismatic", "revolute"))
    assert features.on_circle.scale[0] == features.scale[0] != 1.0
    assert features.on_circle.scale[1:] == (1.0, 1.0)


@pytest.mark.slow
def test_seven_bounded_joints_start_near_the_size_of_the_torque():
    rng = np.random.default_rng(2)
    q, v, a = rng.uniform(-NARROW, NARROW, (200, 7)), rng.normal(size=(200, 7)), rng.normal(size=(200, 7))
    torque = _drawn(q, ("revolute",) * 7).inverse_dynamics(q, v, a)
    assert np.median(torque.var(axis=0)) < NEAR  # the torque that scales were fitted to has variance 1
