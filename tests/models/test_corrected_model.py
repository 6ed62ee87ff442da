"""A corrected model is an inverse dynamics like any other, and the nominal model of the next diagnosis."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.errors import EffectError
from lagnet.models.corrected.changed_bodies import apply_to_bodies
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import load_description
from lagnet.types import InverseDynamics

IDENTITY = 1e-9  # rounding in float64
DIFFERENCED = 1e-7  # forward dynamics from differences of inverse dynamics, in float64

PAYLOAD = {"m": 1.5, "cx": 0.02, "cy": -0.03, "cz": 0.08} | {
    "Ixx": 0.01,
    "Ixy": 0.001,
    "Iyy": 0.012,
    "Ixz": -0.001,
    "Iyz": 0.0005,
    "Izz": 0.008,
}
EFFECTS = (
    NamedEffect("payload", None, PAYLOAD),
    NamedEffect("rotor_inertia", 1, {"Ia": 0.7}),
    NamedEffect("viscous_friction", 0, {"Fv": 4.0}),
    NamedEffect("coulomb_friction", 2, {"Fc": 3.0}),
    NamedEffect("joint_spring", 3, {"k": 5.0, "q0": 0.2}),
    NamedEffect("torque_gain", 4, {"g": 1.1}),
    NamedEffect("torque_offset", 5, {"b": -0.4}),
)
TILT = NamedEffect("gravity_tilt", None, {"theta_1": 0.05, "theta_2": -0.02})
SLOW = np.full(6, 0.02)


@pytest.fixture(scope="module")
def ur5():
    return load_description("ur5")


@pytest.fixture(scope="module")
def model(ur5):
    return CorrectedModel(ur5, EFFECTS, SLOW)


@pytest.fixture(scope="module")
def samples():
    rng = np.random.default_rng(8)
    return [rng.uniform(-2.0, 2.0, (40, 6)) for _ in range(3)]


def test_answers_the_calls_of_inverse_dynamics(model, samples) -> None:
    q, v, a = samples
    assert isinstance(model, InverseDynamics)
    assert model.joints == load_description("ur5").joints
    assert model.n_dof == 6
    assert model.inverse_dynamics(q, v, a).shape == (40, 6)
    assert model.mass_matrix(q).shape == (40, 6, 6)
    assert model.coriolis_torque(q, v).shape == model.gravity_torque(q).shape == (40, 6)


def test_its_terms_add_up_to_its_torque(model, samples) -> None:
    q, v, a = samples
    inertial = np.einsum("nij,nj->ni", model.mass_matrix(q), a)
    parts = inertial + model.coriolis_torque(q, v) + model.gravity_torque(q) + model.residual_torque(q, v, a)
    np.testing.assert_allclose(parts, model.inverse_dynamics(q, v, a), rtol=0, atol=1e3 * IDENTITY)


def test_its_mass_matrix_is_that_of_the_changed_bodies(model, samples) -> None:
    q = samples[0]
    mass = model.mass_matrix(q)
    bodies = model.bodies()
    expected = bodies.mass_matrix(q)
    expected[:, 1, 1] += 0.7  # the rotor is no link
    np.testing.assert_allclose(mass, expected, atol=1e3 * IDENTITY)
    np.testing.assert_allclose(mass, mass.transpose(0, 2, 1), atol=1e3 * IDENTITY)
    assert np.linalg.eigvalsh(mass).min() > 0
    np.testing.assert_allclose(model.gravity_torque(q), bodies.gravity_torque(q), atol=1e3 * IDENTITY)
    np.testing.assert_allclose(
        model.coriolis_torque(q, samples[1]), bodies.coriolis_torque(q, samples[1]), atol=1e3 * IDENTITY
    )


def test_forward_dynamics_invert_inverse_dynamics(model, samples) -> None:
    q, v, a = samples
    back = model.forward_dynamics(q, v, model.inverse_dynamics(q, v, a))
    np.testing.assert_allclose(back, a, atol=DIFFERENCED)


def test_each_effect_adds_its_own_torque(ur5, samples) -> None:
    q, v, a = samples
    nominal = ur5.inverse_dynamics(q, v, a)
    spring = CorrectedModel(ur5, (EFFECTS[4],), SLOW).inverse_dynamics(q, v, a) - nominal
    expected = np.zeros_like(q)
    expected[:, 3] = 5.0 * (q[:, 3] - 0.2)
    np.testing.assert_allclose(spring, expected, atol=1e2 * IDENTITY)


def test_no_effect_changes_nothing(ur5, samples) -> None:
    q, v, a = samples
    np.testing.assert_array_equal(
        CorrectedModel(ur5, (), SLOW).inverse_dynamics(q, v, a), ur5.inverse_dynamics(q, v, a)
    )


def test_samples_without_order_hold_no_delay_and_a_motion_does(ur5) -> None:
    time = np.arange(0.0, 2.0, 0.01)
    angle = 3.0 * time[:, None] + np.arange(6)
    q, v, a = np.sin(angle), 3.0 * np.cos(angle), -9.0 * np.sin(angle)
    late = CorrectedModel(ur5, (NamedEffect("time_delay", 1, {"T": 0.03}),), SLOW)
    nominal = ur5.inverse_dynamics(q, v, a)
    np.testing.assert_array_equal(late.inverse_dynamics(q, v, a), nominal)
    along = late.torque_along(time, q, v, a)
    np.testing.assert_allclose(along[3:, 1], nominal[:-3, 1], atol=1e-6 * np.abs(nominal).max())
    np.testing.assert_array_equal(along[:, 0], nominal[:, 0])


def test_an_effect_with_an_interval_acts_inside_it_alone(ur5) -> None:
    time = np.arange(0.0, 2.0, 0.01)
    q = np.zeros((200, 6))
    pushed = CorrectedModel(ur5, (NamedEffect("torque_offset", 2, {"b": 2.0}, (0.5, 1.0)),), SLOW)
    added = pushed.torque_along(time, q, q, q) - ur5.inverse_dynamics(q, q, q)
    inside = (time >= 0.5) & (time <= 1.0)
    np.testing.assert_allclose(added[:, 2], np.where(inside, 2.0, 0.0), atol=1e2 * IDENTITY)


def test_a_corrected_model_is_the_nominal_model_of_the_next(ur5, samples) -> None:
    q, v, a = samples
    free = CorrectedModel(ur5, EFFECTS[2:4], SLOW)
    loaded = CorrectedModel(free, EFFECTS[:1], SLOW)
    both = CorrectedModel(ur5, (*EFFECTS[:1], *EFFECTS[2:4]), SLOW)
    np.testing.assert_allclose(loaded.inverse_dynamics(q, v, a), both.inverse_dynamics(q, v, a), atol=1e3 * IDENTITY)
    np.testing.assert_allclose(loaded.mass_matrix(q), both.mass_matrix(q), atol=1e3 * IDENTITY)
    np.testing.assert_allclose(loaded.residual_torque(q, v, a), free.residual_torque(q, v, a), atol=1e3 * IDENTITY)
    np.testing.assert_allclose(loaded.bodies().gravity_torque(q), both.bodies().gravity_torque(q), atol=1e3 * IDENTITY)


@pytest.mark.parametrize("effect", [EFFECTS[0], TILT], ids=lambda e: e.effect)
def test_what_is_written_into_the_bodies_is_the_effect(ur5, samples, effect) -> None:
    q, v, a = samples
    written = apply_to_bodies(ur5, [effect])
    expected = CorrectedModel(ur5, (effect,), SLOW).inverse_dynamics(q, v, a)
    np.testing.assert_allclose(written.inverse_dynamics(q, v, a), expected, atol=1e3 * IDENTITY)


def test_a_link_change_is_written_at_its_own_link() -> None:
    arm = random_arm(4, seed=3, kinds=("revolute",))
    change = dict(zip(("dm", "dmcx", "dmcy", "dmcz"), (0.4, 0.02, 0.0, -0.01), strict=True))
    change |= {n: 0.01 * (n in ("dIxx", "dIyy", "dIzz")) for n in ("dIxx", "dIxy", "dIyy", "dIxz", "dIyz", "dIzz")}
    effect = NamedEffect("link_inertia", 1, change)
    q, v, a = (np.random.default_rng(k).uniform(-1, 1, (20, 4)) for k in range(3))
    corrected = CorrectedModel(arm, (effect,), np.full(4, 0.01))
    np.testing.assert_allclose(
        corrected.bodies().inverse_dynamics(q, v, a), corrected.inverse_dynamics(q, v, a), atol=1e3 * IDENTITY
    )


def test_a_model_without_bodies_refuses_to_hold_a_payload() -> None:
    class Plain:
        joints, n_dof = ("a",), 1

    with pytest.raises(EffectError, match="no bodies"):
        apply_to_bodies(Plain(), EFFECTS[:1])
