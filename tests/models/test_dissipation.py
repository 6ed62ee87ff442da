"""An ε of drag and friction with a motion of its own holds the drag of real bodies."""

from __future__ import annotations

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from lagnet.errors import ModelError
from lagnet.models.features import fit_features
from lagnet.models.kinds import AugmentedSettings, ModelSpec, draw, settings_from
from lagnet.models.lagrangians.delan import DelanSettings
from lagnet.models.learned_model import LearnedModel
from lagnet.models.residuals.augmented import Augmented
from lagnet.models.residuals.dissipation import DRAGS, DissipationSettings
from lagnet.models.scales import Scales, fit_scales

pytestmark = pytest.mark.slow

IDENTITY = 1e-9  # float64 rounding of about a thousand operations on numbers of order 1 to 100
ROUNDED_TIP = 1e-4  # |ω| is rounded below a thousandth of a typical speed
SMALL = DelanSettings(rank=3, potential_rank=3)
TYPES = ("continuous", "prismatic", "revolute")


@pytest.fixture(scope="module")
def motion() -> tuple[np.ndarray, ...]:
    rng = np.random.default_rng(3)
    return tuple(rng.normal(size=(40, 3)) for _ in range(3))


@pytest.fixture(scope="module")
def model() -> LearnedModel:
    q, v, a, tau = np.random.default_rng(0).normal(size=(4, 60, 3))
    settings = AugmentedSettings(form="dissipation", residual=DissipationSettings(rank=4), mechanics_settings=SMALL)
    spec = ModelSpec("delan-ffnn", settings, ("a", "b", "c"), fit_features(q, TYPES), fit_scales(v, a, tau))
    return LearnedModel(spec, draw(spec, jax.random.key(1)))


def test_it_holds_drag_that_is_the_gradient_of_nothing():
    # A ball joint of three turns about one point at q = 0: moments differ, so I ω |ω| has a curl
    moments, turn = np.diag([1.0, 2.0, 5.0]), np.eye(3)
    q, v, a = np.random.default_rng(0).normal(size=(3, 60, 3))
    settings = AugmentedSettings(form="dissipation", residual=DissipationSettings(rank=3), mechanics_settings=SMALL)
    spec = ModelSpec("delan-ffnn", settings, ("a", "b", "c"), fit_features(q, TYPES), Scales(*[(1.0,) * 3] * 3))
    dynamics = draw(spec, jax.random.key(1))
    assert isinstance(dynamics, Augmented)
    one = np.zeros((DRAGS, 3, 3, 3))
    one[0, 2] = turn
    root = np.zeros((DRAGS, 3, 3, 3))
    root[0, 2] = np.sqrt(moments)
    still = tuple(
        np.concatenate([turn, np.zeros((3, t.shape[1] - 3))], axis=1) for t in dynamics.residual.motion.transfers
    )
    values = (still, turn, np.zeros((3, 3, 3)), one, root, np.zeros(3), np.zeros(3))
    with jax.enable_x64(True):
        values = jax.tree.map(jnp.asarray, values)
    drag = eqx.tree_at(
        lambda x: (x.motion.transfers, x.axes, x.linear, x.speeds, x.quadratic, x.viscous, x.dry),
        dynamics.residual,
        values,
    )
    with jax.enable_x64(True):
        found = np.asarray(jax.vmap(drag)(q, v, a))
    np.testing.assert_allclose(found, np.linalg.norm(v, axis=1, keepdims=True) * v @ moments, rtol=ROUNDED_TIP)


def test_shares_scale_the_torque_of_each_joint(model, motion):
    dynamics = model.dynamics
    assert isinstance(dynamics, Augmented)
    q, v, a = (x[0] for x in motion)
    shares = np.array([1.0, 0.0, 0.5])
    with jax.enable_x64(True):
        sample = tuple(jnp.asarray(x) for x in (q, v, a))
        found = dynamics.residual.scaled(shares)(*sample)
        np.testing.assert_allclose(found, shares * np.asarray(dynamics.residual(*sample)), atol=IDENTITY)


def test_settings_of_another_form_are_refused():
    with pytest.raises(ModelError, match="no setting 'hidden'"):
        settings_from("delan-ffnn", {"form": "dissipation", "residual": {"hidden": [4]}})
    with pytest.raises(ModelError, match="dissipation"):
        AugmentedSettings(form="dissipatoin")
    with pytest.raises(ModelError, match="rank"):
        DissipationSettings(rank=0)
