"""What every kind of learned model must do, whatever it is made of."""

from __future__ import annotations

from functools import cache
from typing import Any

import jax
import numpy as np
import pytest

from lagnet.errors import ModelError
from lagnet.models.features import fit_features
from lagnet.models.files.saving import load_model
from lagnet.models.kinds import KINDS, AugmentedSettings, ModelSpec, draw, settings_class
from lagnet.models.learned_model import LearnedModel
from lagnet.models.residuals.torque_network import TorqueNetworkSettings
from lagnet.models.scales import fit_scales
from lagnet.types import InverseDynamics

pytestmark = pytest.mark.xdist_group("model_conformance")  # what they share is made once

IDENTITY = 1e-9  # float64 rounding of about a thousand operations on numbers of order 1 to 100
AUTODIFF = 1e-5  # central differences at step 1e-6: truncation plus rounding
TYPES = ("continuous", "prismatic", "revolute")
FORMS = ("dissipation", "body-drag")  # of ε, beside the perceptron
WITH_FORMS = [f"delan-ffnn {form}" for form in FORMS]
LEARNED = [*(kind for kind in KINDS if kind != "serial-chain"), *WITH_FORMS]
MECHANICAL = ["delan", "delan-perceptron", "delan-ffnn", *WITH_FORMS]
QUICK = ("delan", "ffnn", "delan-ffnn")  # each kind compiles for itself; the others with the slow tests


def each(kinds: list[str]) -> list[Any]:
    """Parameters of all kinds, those that are not quick marked slow."""
    return [kind if kind in QUICK else pytest.param(kind, marks=pytest.mark.slow) for kind in kinds]


def settings_of(kind: str) -> Any:
    small = {"hidden": (8, 8)}
    if kind in WITH_FORMS:
        return AugmentedSettings(form=kind.split()[1])
    if kind == "delan-ffnn":
        return AugmentedSettings(residual=TorqueNetworkSettings(**small), parity="odd")
    return settings_class(kind)() if kind == "delan" else settings_class(kind)(**small)


@pytest.fixture(scope="module")
def motion() -> tuple[np.ndarray, ...]:
    rng = np.random.default_rng(3)
    return tuple(rng.normal(size=(5, 3)) for _ in range(3))


@cache
def made(kind: str) -> LearnedModel:
    """One model of a kind and form of ε with random weights; kept, since compiling takes longer than all tests."""
    rng = np.random.default_rng(0)
    q, v, a, tau = rng.normal(size=(4, 60, 3))
    spec = ModelSpec(kind.split()[0], settings_of(kind), ("a", "b", "c"), fit_features(q, TYPES), fit_scales(v, a, tau))
    drawn = draw(spec, jax.random.key(1))
    if kind == "delan-ffnn":  # an ε that starts at zero would hide mistakes in it
        drawn = jax.tree.map(lambda x: x + 0.1, drawn)
    return LearnedModel(spec, drawn)


@pytest.fixture(scope="module", params=each(LEARNED))
def model(request: Any) -> LearnedModel:
    return made(request.param)


def test_answers_the_protocol(model):
    assert isinstance(model, InverseDynamics)
    assert model.n_dof == 3


def test_the_terms_and_the_residual_add_up_to_the_torque(model, motion):
    q, v, a = motion
    inertial = np.einsum("nij,nj->ni", model.mass_matrix(q), a)
    terms = inertial + model.coriolis_torque(q, v) + model.gravity_torque(q) + model.residual_torque(q, v, a)
    np.testing.assert_allclose(terms, model.inverse_dynamics(q, v, a), atol=IDENTITY)


@pytest.mark.parametrize("kind", each(MECHANICAL))  # an untrained network without form need not have an inverse
def test_forward_dynamics_undo_inverse_dynamics(kind, motion):
    model, (q, v, a) = made(kind), motion
    found = model.forward_dynamics(q, v, model.inverse_dynamics(q, v, a))
    np.testing.assert_allclose(found, a, atol=1e-6)


@pytest.mark.parametrize("kind", each(MECHANICAL))
def test_mechanics_are_positive_symmetric_and_skew(kind, motion):
    model, (q, v, _) = made(kind), motion
    mass, coriolis = model.mass_matrix(q), model.coriolis_matrix(q, v)
    np.testing.assert_allclose(mass, mass.transpose(0, 2, 1), atol=IDENTITY)
    assert np.linalg.eigvalsh(mass).min() > 0
    np.testing.assert_allclose(np.einsum("nij,nj->ni", coriolis, v), model.coriolis_torque(q, v), atol=IDENTITY)
    h = 1e-6
    rate = (model.mass_matrix(q + h * v) - model.mass_matrix(q - h * v)) / (2 * h)
    np.testing.assert_allclose(coriolis + coriolis.transpose(0, 2, 1), rate, atol=AUTODIFF, rtol=AUTODIFF)


def test_torques_follow_from_the_energies(model, motion):
    if model.model_kind == "ffnn":
        with pytest.raises(ModelError, match="no energies"):
            model.potential_energy(motion[0])
        return
    q, v, a = motion
    h = 1e-6
    gravity = np.zeros_like(q)
    for joint in range(3):
        step = h * np.eye(3)[joint]
        gravity[:, joint] = (model.potential_energy(q + step) - model.potential_energy(q - step)) / (2 * h)
    np.testing.assert_allclose(model.gravity_torque(q), gravity, atol=AUTODIFF, rtol=AUTODIFF)
    if model.model_kind in ("delan", "delan-perceptron"):  # the power that goes in is the rate of the energy
        power = np.sum(v * model.inverse_dynamics(q, v, a), axis=1)
        ahead, behind = ((q + s * h * v, v + s * h * a) for s in (1, -1))
        energy = [model.kinetic_energy(*x) + model.potential_energy(x[0]) for x in (ahead, behind)]
        np.testing.assert_allclose(power, (energy[0] - energy[1]) / (2 * h), atol=1e-4, rtol=AUTODIFF)


def test_epsilon_of_odd_parity_changes_sign_with_the_velocity(motion):
    model, (q, v, a) = made("delan-ffnn"), motion
    np.testing.assert_allclose(model.residual_torque(q, v, a), -model.residual_torque(q, -v, a), atol=IDENTITY)
    assert np.abs(model.residual_torque(q, v, a)).max() > 1e-3


def test_a_saved_model_comes_back_the_same(model, motion, tmp_path):
    again = load_model(model.save(tmp_path / "model"), n_dof=3)
    np.testing.assert_array_equal(again.inverse_dynamics(*motion), model.inverse_dynamics(*motion))
    assert again.joints == model.joints
    assert again.joint_types == TYPES


def test_batches_of_any_size_give_what_single_samples_give(model, motion):
    together = model.gravity_torque(motion[0])
    alone = np.concatenate([model.gravity_torque(row[None]) for row in motion[0]])
    np.testing.assert_allclose(together, alone, atol=IDENTITY)


def test_wrong_shapes_are_refused(model):
    with pytest.raises(ValueError, match="expected"):
        model.mass_matrix(np.zeros((4, 2)))
