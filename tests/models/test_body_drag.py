"""Drag on the bodies of mechanics follows their motion and is learned with them."""

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
from lagnet.models.residuals.body_drag import BodyDragSettings, Dragged
from lagnet.models.scales import Scales
from lagnet.recordings.recording import Recording
from lagnet.training.settings import TrainingSettings
from lagnet.training.train import train

pytestmark = pytest.mark.slow

ROUNDED_TIP = 1e-4  # |ω| is rounded below a thousandth of a typical speed
TYPES = ("continuous", "prismatic", "revolute")
SETTINGS = AugmentedSettings(
    form="body-drag", residual=BodyDragSettings(2), mechanics_settings=DelanSettings(rank=3, potential_rank=3)
)


@pytest.fixture(scope="module")
def motion() -> tuple[np.ndarray, ...]:
    rng = np.random.default_rng(3)
    return tuple(rng.normal(size=(40, 3)) for _ in range(3))


def test_it_follows_the_bodies_of_the_mechanics(motion):
    """A ball joint of three turns about one point at q = 0: the mechanics' motion is v, drag is I ω |ω|."""
    moments, turn = np.diag([1.0, 2.0, 5.0]), np.eye(3)
    q, v, a = motion
    spec = ModelSpec("delan-ffnn", SETTINGS, ("a", "b", "c"), fit_features(q, TYPES), Scales(*[(1.0,) * 3] * 3))
    dynamics = draw(spec, jax.random.key(1))
    assert isinstance(dynamics, Dragged)
    zeros, one, root = np.zeros((3, 3, 3)), np.zeros((2, 3, 3, 3)), np.zeros((2, 3, 3, 3))
    one[0, 2], root[0, 2] = turn, np.sqrt(moments)
    arm = dynamics.mechanics.lagrangian
    still = tuple(np.concatenate([turn, np.zeros((3, t.shape[1] - 3))], axis=1) for t in arm.motion.transfers)
    with jax.enable_x64(True):
        values = jax.tree.map(jnp.asarray, (still, turn, zeros, one, root, np.zeros(3), np.zeros(3)))
    dynamics = eqx.tree_at(
        lambda x: (
            *(x.mechanics.lagrangian.motion.transfers, x.mechanics.lagrangian.axes),
            *(x.residual.linear, x.residual.speeds, x.residual.quadratic, x.residual.viscous, x.residual.dry),
        ),
        dynamics,
        values,
    )
    with jax.enable_x64(True):
        found = np.asarray(jax.vmap(dynamics.epsilon)(q, v, a))
    np.testing.assert_allclose(found, np.linalg.norm(v, axis=1, keepdims=True) * v @ moments, rtol=ROUNDED_TIP)


@pytest.mark.slow
def test_it_learns_with_its_mechanics_and_not_in_stages():
    """One prismatic joint with mass 2 kg and drag 3 v |v| + v."""
    rng = np.random.default_rng(0)
    q, v, a = rng.normal(size=(3, 2000, 1))
    time, tau = np.arange(2000) * 0.01, 2.0 * a + 3.0 * v * np.abs(v) + v
    recording = Recording(time=time, q=q, v=v, a=a, tau=tau, joints=("x",))
    together = TrainingSettings(steps=1500, penalty=0.0, separation="joint")
    small = AugmentedSettings(form="body-drag", mechanics_settings=DelanSettings(rank=3, potential_rank=2))
    given = {"joint_types": ("prismatic",), "settings": small}
    model = train([recording], "delan-ffnn", training=together, **given).model
    np.testing.assert_allclose(model.mass_matrix(q[:9]), 2.0, rtol=1e-2)
    error = model.residual_torque(q, v, a) - (tau - 2.0 * a)
    assert np.mean(error**2) < 1e-3 * tau.var()
    with pytest.raises(ModelError, match="in stages"):
        train([recording], "delan-ffnn", training=TrainingSettings(steps=100), **given)


def test_settings_that_do_not_go_together_are_refused():
    with pytest.raises(ModelError, match="not of delan-blackbox"):
        settings_from("delan-ffnn", {"form": "body-drag", "mechanics": "delan-blackbox"})
    with pytest.raises(ModelError, match="drags"):
        BodyDragSettings(drags=0)
