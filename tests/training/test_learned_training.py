"""Training learns, stops, resumes to the same weights, and refuses what it cannot use."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import optax
import pytest

from lagnet.errors import LagnetError, ModelError
from lagnet.models.features import fit_features, guess_joint_types
from lagnet.models.kinds import AugmentedSettings, ModelSpec, draw
from lagnet.models.lagrangians.delan import DelanSettings
from lagnet.models.residuals.torque_network import TorqueNetworkSettings
from lagnet.models.scales import fit_scales
from lagnet.recordings.recording import Recording
from lagnet.training.checkpoint import read_checkpoint, write_checkpoint
from lagnet.training.optimisation.loss import Errors, errors, penalised
from lagnet.training.optimisation.soap import scale_by_soap
from lagnet.training.samples import samples_of
from lagnet.training.settings import TrainingSettings
from lagnet.training.train import train

pytestmark = pytest.mark.slow

TINY = DelanSettings(rank=3, potential_rank=3)
SHORT = TrainingSettings(steps=300, batch=64, patience=1.0, learning_rate=5e-2)


def pendulum(n: int = 800, seed: int = 0) -> Recording:
    """One joint under gravity: τ = 0.7 a + 3 sin q."""
    rng = np.random.default_rng(seed)
    q, v, a = rng.uniform(-3, 3, (n, 1)), rng.normal(size=(n, 1)), rng.normal(size=(n, 1))
    return Recording(
        time=0.01 * np.arange(n),
        q=q,
        v=v,
        a=a,
        tau=0.7 * a + 3.0 * np.sin(q),
        joints=("swing",),
        trajectory=np.arange(n) // 100,
        trajectory_names=tuple(map(str, range(-(-n // 100)))),
    )


@pytest.fixture(scope="module")
def fitted() -> Any:
    return train([pendulum()], settings=TINY, training=SHORT)


def test_a_pendulum_is_learned(fitted):
    assert max(fitted.stats["held_out_error"]) < 1e-3
    mass = fitted.model.mass_matrix(np.array([[0.3]]))[0, 0, 0]
    assert mass == pytest.approx(0.7, rel=0.02)


def test_the_same_seed_gives_the_same_model_and_the_stats_say_how(fitted):
    again = train([pendulum()], settings=TINY, training=SHORT)
    q = np.array([[0.4]])
    np.testing.assert_array_equal(again.model.gravity_torque(q), fitted.model.gravity_torque(q))
    assert fitted.stats["seed"] == 0
    assert fitted.stats["steps"] == SHORT.steps
    assert len(fitted.history.reports[-1].held_out) == 1
    assert "held out by joint" in fitted.history.reports[-1].line()


class Killed(Exception):
    """Stands for the process dying between two chunks."""


def test_a_killed_training_resumes_to_the_same_weights(fitted, tmp_path, monkeypatch):
    monkeypatch.setattr("lagnet.training.optimisation.fit.CHECKPOINT_EVERY", 0.0)
    path = tmp_path / "run.npz"

    def dies_late(report: Any) -> None:
        if report.step >= 200:
            raise Killed

    with pytest.raises(Killed):
        train([pendulum()], settings=TINY, training=SHORT, checkpoint=path, progress=dies_late)
    assert path.exists()
    again: list = []
    resumed = train([pendulum()], settings=TINY, training=SHORT, checkpoint=path, progress=again.append)
    assert again[0].step > 100
    assert [r.step for r in resumed.history.reports] == [r.step for r in fitted.history.reports]
    assert resumed.stats["held_out_error"] == fitted.stats["held_out_error"]
    q = np.array([[0.4]])
    np.testing.assert_array_equal(resumed.model.gravity_torque(q), fitted.model.gravity_torque(q))


def test_a_checkpoint_of_another_run_or_a_damaged_one_is_refused(tmp_path):
    state = {"x": jnp.arange(3.0), "key": jax.random.key(4)}
    path = tmp_path / "state.npz"
    write_checkpoint(path, state, "mine", [{"step": 100}])
    back, told = read_checkpoint(path, state, "mine")
    assert told == [{"step": 100}]
    np.testing.assert_array_equal(back["x"], state["x"])
    assert jax.random.uniform(back["key"]) == jax.random.uniform(state["key"])
    with pytest.raises(ModelError, match="another training"):
        read_checkpoint(path, state, "yours")
    path.write_bytes(b"no archive")
    with pytest.raises(ModelError, match="damaged"):
        read_checkpoint(path, state, "mine")


def test_soap_goes_down_an_ill_conditioned_valley_faster_than_adam():
    target = jnp.asarray(np.random.default_rng(0).normal(size=(6, 6)))
    turn = jnp.linalg.qr(jnp.asarray(np.random.default_rng(1).normal(size=(6, 6))))[0]
    steep = turn @ jnp.diag(jnp.logspace(0, 2, 6))

    def loss(w: jax.Array) -> jax.Array:
        return jnp.mean((steep.T @ (w - target)) ** 2)

    def after(direction: optax.GradientTransformation) -> float:
        def step(carry: Any, k: Any) -> Any:
            w, state = carry
            update, state = direction.update(jax.grad(loss)(w), state, w)
            return (w - 0.1 * (1 - k / 300) * update, state), None

        start = jnp.zeros((6, 6), target.dtype)
        (w, _), _ = jax.lax.scan(step, (start, direction.init(start)), jnp.arange(300))
        return float(loss(w))

    assert after(scale_by_soap()) < 0.1 * after(optax.scale_by_adam())


def test_the_penalty_of_equation_12_holds_epsilon_down():
    found = Errors(torque=jnp.array([1.0, 3.0]), epsilon=jnp.array([0.5, 0.5]))
    assert float(penalised(found, 0.1)) == pytest.approx(2.05)


def test_gradients_of_the_loss_agree_with_finite_differences():
    rng = np.random.default_rng(0)
    q, v, a, tau = rng.normal(size=(4, 8, 2))
    with jax.enable_x64(True):
        features = fit_features(q, ("revolute", "prismatic"))
        settings = AugmentedSettings(mechanics_settings=TINY, residual=TorqueNetworkSettings(hidden=(4,)))
        model = draw(ModelSpec("delan-ffnn", settings, ("a", "b"), features, fit_scales(v, a, tau)), jax.random.key(0))
        leaves, tree = jax.tree.flatten(model)
        way = [jnp.asarray(rng.normal(size=x.shape)) for x in leaves]

        def loss(s: Any) -> jax.Array:
            moved = tree.unflatten([jnp.asarray(x, jnp.float64) + s * w for x, w in zip(leaves, way, strict=True)])
            return penalised(errors(moved, tuple(map(jnp.asarray, (q, v, a, tau))), jnp.ones(2)), 0.3)

        slope, compiled, h = jax.jit(jax.grad(loss))(0.1), jax.jit(loss), 1e-6
        assert float(slope) == pytest.approx(float((compiled(0.1 + h) - compiled(0.1 - h)) / (2 * h)), rel=1e-5)


def test_joint_types_are_told_by_range():
    q = np.stack([np.linspace(-3, 3, 50), np.linspace(0, 1, 50)], axis=1)
    assert guess_joint_types(q) == ("continuous", "revolute")


@pytest.mark.parametrize(
    "call",
    [
        lambda: train([]),
        lambda: train([pendulum(30)]),
        lambda: train([replace(pendulum(), tau=np.ones((800, 1)))]),
        lambda: train([pendulum(), replace(pendulum(), joints=("other",))], holdout=[pendulum()]),
        lambda: train([pendulum()], model="delaan"),
        lambda: train([pendulum()], joint_types=("spherical",)),
        lambda: TrainingSettings(optimiser="luck"),
        lambda: TrainingSettings(minutes=-1.0),
    ],
)
def test_what_cannot_be_trained_on_is_refused(call):
    with pytest.raises(LagnetError):
        call()


def test_missing_velocities_are_derived():
    time = 0.01 * np.arange(600)
    q = np.sin(time)[:, None]
    run = Recording(time=time, q=q, tau=0.7 * -q, joints=("swing",))
    samples = samples_of([run])
    middle = slice(len(samples) // 4, 3 * len(samples) // 4)
    np.testing.assert_allclose(samples.a[middle], -samples.q[middle], atol=0.02)


def test_a_stack_of_matrices_is_stepped_as_its_matrices_are():
    rng = np.random.default_rng(5)
    grads = [rng.normal(size=(3, 4, 2)) for _ in range(15)]
    together, apart = scale_by_soap(), scale_by_soap()
    stack, singles = jnp.zeros((3, 4, 2)), [jnp.zeros((4, 2))] * 3
    one, many = together.init(stack), apart.init(singles)
    for grad in grads:
        step, one = together.update(jnp.asarray(grad, jnp.float32), one)
        steps, many = apart.update([jnp.asarray(g, jnp.float32) for g in grad], many)
    np.testing.assert_allclose(step, np.stack(steps), rtol=1e-5, atol=1e-6)
