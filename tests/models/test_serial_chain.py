"""A serial chain found from torque alone, against Pinocchio; its equations against Euler and Lagrange."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tests.models.term_by_term import GravityInResidual, WithoutCoriolis, failures

from lagnet.effects.catalogue import effect_named
from lagnet.errors import ModelError
from lagnet.models.corrected.model import CorrectedModel, NamedEffect
from lagnet.models.files.loading import load_any
from lagnet.models.lagrangians import euler_lagrange
from lagnet.models.learned_model import LearnedModel
from lagnet.models.serial_chain.identification.fit import fit_serial_chain
from lagnet.models.serial_chain.identification.lifting import lifted_regressor
from lagnet.models.serial_chain.identification.search import search_axes
from lagnet.models.serial_chain.identification.separable import make_samples
from lagnet.models.serial_chain.identification.unknowns import STANDARD_GRAVITY, Unknowns, normalise_gravity
from lagnet.models.serial_chain.mechanics.inertia import from_standard, pseudo_inertia, to_standard
from lagnet.models.serial_chain.mechanics.kinematics import Geometry, revolute_mask
from lagnet.models.serial_chain.mechanics.newton_euler import SerialArm, moment_regressor
from lagnet.models.serial_chain.model import SerialChain, learn_serial_chain, load_serial_chain
from lagnet.models.serial_chain.reversals import sharpen_reversals
from lagnet.models.serial_chain.settings import SearchSettings, SerialChainSettings
from lagnet.rigid_body.descriptions.urdf import read_urdf
from lagnet.rigid_body.descriptions.xml_files import checked_xml
from lagnet.rigid_body.inertia import is_physically_consistent
from lagnet.rigid_body.robot import Robot
from lagnet.types import InverseDynamics

pytestmark = pytest.mark.slow

IDENTITY = 1e-9  # two algorithms on one arm in float64
EXACT = 1e-12  # nMSE of a term from noise-free torque: the pass line
SAMPLES = 200

URDF = """<robot name="three">
<link name="base"/>
<link name="a"><inertial><origin xyz="0.1 0.02 0.05" rpy="0.3 0.1 0"/><mass value="3"/>
 <inertia ixx="0.02" iyy="0.03" izz="0.025" ixy="0.001" ixz="0.002" iyz="-0.001"/></inertial></link>
<link name="b"><inertial><origin xyz="0.05 -0.03 0.1"/><mass value="2"/>
 <inertia ixx="0.01" iyy="0.012" izz="0.009" ixy="0" ixz="0.001" iyz="0"/></inertial></link>
<link name="c"><inertial><origin xyz="0.02 0.06 0.04"/><mass value="1.2"/>
 <inertia ixx="0.004" iyy="0.003" izz="0.005" ixy="0.0005" ixz="0" iyz="0"/></inertial></link>
<joint name="turn" type="revolute"><parent link="base"/><child link="a"/><origin xyz="0 0 0.3" rpy="0.4 0.2 0"/>
 <axis xyz="0 0 1"/><limit lower="-2.5" upper="2.5" effort="100" velocity="5"/></joint>
<joint name="slide" type="prismatic"><parent link="a"/><child link="b"/><origin xyz="0.3 0 0.1" rpy="0.9 0.3 0.2"/>
 <axis xyz="0 1 0"/><limit lower="-0.4" upper="0.4" effort="100" velocity="5"/></joint>
<joint name="wrist" type="revolute"><parent link="b"/><child link="c"/><origin xyz="0.1 0.1 0.2" rpy="-0.5 0.7 0"/>
 <axis xyz="1 0 0"/><limit lower="-2.5" upper="2.5" effort="100" velocity="5"/></joint>
</robot>"""


def _motion(robot: Robot, n: int, seed: int) -> tuple[np.ndarray, ...]:
    rng = np.random.default_rng(seed)
    shape = (n, robot.n_dof)
    return (
        rng.uniform(robot.position_lower, robot.position_upper, shape),
        rng.normal(size=shape),
        rng.normal(size=shape),
    )


def _nmse(got: np.ndarray, want: np.ndarray) -> float:
    return float(np.max(np.mean((got - want) ** 2, axis=0) / want.var(axis=0)))


@pytest.fixture(scope="module")
def robot() -> Robot:
    return Robot(read_urdf(checked_xml(URDF.encode(), "three")))


@pytest.fixture(scope="module")
def learned(robot: Robot) -> tuple:
    q, v, a = _motion(robot, SAMPLES, 0)
    tau = robot.inverse_dynamics(q, v, a)
    return learn_serial_chain(q, v, a, tau, robot.joints, robot.joint_types, seed=0)


@pytest.fixture
def anything() -> SerialArm:
    """An arm of any constants, one joint of three prismatic."""
    rng = np.random.default_rng(3)
    with jax.enable_x64(True):
        geometry = Geometry(*(jnp.asarray(rng.normal(size=s)) for s in ((2, 2), (2, 2), (3,))))
        return SerialArm(
            geometry, jnp.asarray(rng.normal(size=(3, 10))), jnp.asarray([0.1, 0.2, 0.3]), (True, False, True)
        )


def _state(seed: int) -> list:
    return [jnp.asarray(x) for x in np.random.default_rng(seed).normal(size=(3, 3))]


def test_newton_euler_agrees_with_the_energies(anything: SerialArm) -> None:
    with jax.enable_x64(True):
        q, v, a = _state(0)
        torque = jax.jit(lambda *s: anything.inverse_dynamics(*s))(q, v, a)
        want = jax.jit(lambda *s: euler_lagrange.inverse_dynamics(anything, *s))(q, v, a)
        np.testing.assert_allclose(torque, want, rtol=IDENTITY, atol=1e-8)


def test_torque_is_linear_in_the_moments(anything: SerialArm) -> None:
    with jax.enable_x64(True):
        q, v, a = _state(1)
        columns = moment_regressor(anything.geometry, anything.revolute, q, v, a)
        torque = columns @ anything.moments.reshape(-1) + anything.rotor_inertia * a
        np.testing.assert_allclose(torque, anything.inverse_dynamics(q, v, a), rtol=IDENTITY, atol=1e-8)


def test_relaxation_holds_every_arm_of_its_axes_and_no_other(anything: SerialArm) -> None:
    with jax.enable_x64(True):
        states = [jnp.stack(part) for part in zip(*map(_state, range(60)), strict=True)]
        torque = np.asarray(
            jax.jit(jax.vmap(anything.inverse_dynamics))(*states) - anything.rotor_inertia[None] * states[2]
        )

        @jax.jit
        def relaxed(angles):
            return jax.vmap(lambda *s: lifted_regressor(angles, anything.revolute, *s))(*states)

        def left(angles) -> float:
            columns = np.asarray(relaxed(angles)).reshape(torque.size, -1)
            best = np.linalg.lstsq(columns, torque.ravel(), rcond=1e-12)[0]
            return float(np.sum((columns @ best - torque.ravel()) ** 2) / np.sum(torque**2))

        assert left(anything.geometry.angles) < 1e-18
        assert left(anything.geometry.angles + 0.3) > 1e-4


def test_standard_parameters_and_moments_are_inverse_maps() -> None:
    moments = np.random.default_rng(0).normal(size=(4, 10))
    np.testing.assert_allclose(from_standard(to_standard(moments)), moments, atol=1e-12)
    assert to_standard(moments)[0, 0] == pytest.approx(moments[0, 9])


def test_unit_of_length_is_free_for_turning_joints() -> None:
    rng = np.random.default_rng(1)
    unknowns = Unknowns((True, True, True), (), (1.0, 1.0, 1.0))
    x, moments = rng.normal(size=unknowns.scale.size), rng.normal(size=(3, 10))
    x_new, moments_new = normalise_gravity(unknowns, x, moments)
    q, v, a = rng.normal(size=(3, 5, 3))
    with jax.enable_x64(True):
        before = unknowns.torque(x, moments.ravel(), q, v, a)
        after = unknowns.torque(x_new, moments_new.ravel(), q, v, a)
    np.testing.assert_allclose(after, before, rtol=IDENTITY, atol=1e-9)
    assert np.linalg.norm(x_new[-3:]) == pytest.approx(STANDARD_GRAVITY)


def failed(model: Any, robot: Robot) -> set[str]:
    return failures(model, robot, _motion(robot, 300, 99), EXACT, EXACT**0.5, EXACT)


@pytest.mark.slow
def test_every_term_is_found_from_torque_alone(robot: Robot, learned: tuple) -> None:
    model = learned[0]
    assert failed(model, robot) == set()
    np.testing.assert_array_equal(model.residual_torque(*_motion(robot, 300, 99)), 0.0)


def test_mutants_of_the_chain_fail_where_they_are_wrong(robot: Robot, learned: tuple) -> None:
    model = learned[0]
    assert {"torque", "coriolis", "coriolis_matrix"} <= failed(WithoutCoriolis(model), robot)
    assert failed(GravityInResidual(model), robot) == {"gravity"}


def test_a_chain_of_shuffled_torque_fails_in_every_term(robot: Robot, learned: tuple) -> None:
    q, v, a = _motion(robot, 500, 4)
    tau = np.random.default_rng(0).permutation(robot.inverse_dynamics(q, v, a))
    columns = learned[0].joint_torque_regressor(q, v, a).reshape(tau.size, -1)
    links = np.linalg.lstsq(columns, tau.ravel(), rcond=1e-9)[0].reshape(3, 10)
    moments = from_standard(links)
    dynamics = eqx.tree_at(lambda x: x.lagrangian.moments, learned[0].dynamics, jnp.asarray(moments))
    wrong = {"torque", "inertial", "coriolis", "coriolis_matrix", "gravity", "mass_matrix", "forward_dynamics"}
    assert failed(LearnedModel(learned[0].spec, dynamics), robot) == wrong


def test_a_prismatic_joint_lets_gravity_be_measured(learned: tuple, robot: Robot) -> None:
    assert np.linalg.norm(learned[0].gravity) == pytest.approx(np.linalg.norm(robot.gravity), rel=1e-6)


def test_energies_give_the_torque_of_free_motion(robot: Robot, learned: tuple) -> None:
    model = learned[0]
    q, v, _ = _motion(robot, 1, 3)
    a, step = np.zeros_like(v), 1e-5
    power = np.sum(model.inverse_dynamics(q, v, a) * v)

    def energy(t: float) -> float:
        return float((model.kinetic_energy(q + t * v, v) + model.potential_energy(q + t * v))[0])

    assert (energy(step) - energy(-step)) / (2 * step) == pytest.approx(power, rel=1e-6)


def test_links_can_exist(learned: tuple) -> None:
    model, found = learned
    assert found.physical
    assert np.all(is_physically_consistent(model.inertial_parameters))
    with jax.enable_x64(True):
        matrices = np.asarray(pseudo_inertia(jnp.asarray(found.moments)))
    assert np.linalg.eigvalsh(matrices).min() > 0


def test_what_is_determined_is_right_and_the_rest_is_said(robot: Robot, learned: tuple) -> None:
    found = learned[1].determinacy
    assert 0 < found.determined.sum() < 30
    assert found.base_matrix.shape == (found.base_rank, 30)
    assert not found.determined[0, 0]  # the mass of the first link never moves against gravity alone
    mass = learned[0].inertial_parameters[1, 0] + learned[0].inertial_parameters[2, 0]
    assert mass == pytest.approx(3.2, rel=1e-6)  # what slides is weighed, though not link by link


def test_regressor_times_parameters_is_torque(robot: Robot, learned: tuple) -> None:
    model = learned[0]
    q, v, a = _motion(robot, 7, 5)
    columns = model.joint_torque_regressor(q, v, a)
    torque = columns @ model.inertial_parameters.ravel()
    np.testing.assert_allclose(torque, model.inverse_dynamics(q, v, a), rtol=1e-8, atol=1e-9)
    np.testing.assert_array_equal(model.link_regressor(-1, q, v, a), columns[:, :, 20:])
    np.testing.assert_allclose(
        model.gravity_regressor(q) @ model.gravity, model.gravity_torque(q), rtol=1e-8, atol=1e-9
    )
    weights = sum(model.weight_regressor(k, q) @ p for k, p in enumerate(model.inertial_parameters))
    np.testing.assert_allclose(np.tensordot(model.gravity, weights, 1), model.gravity_torque(q), rtol=1e-8, atol=1e-9)


def test_mounted_otherwise_only_its_weight_differs(robot: Robot, learned: tuple) -> None:
    model, motion = learned[0], _motion(robot, 7, 6)
    gravity = model.gravity[[1, 2, 0]] + 0.5
    other = model.with_gravity(gravity)
    weight = model.gravity_regressor(motion[0]) @ (gravity - model.gravity)
    np.testing.assert_allclose(
        other.inverse_dynamics(*motion), model.inverse_dynamics(*motion) + weight, rtol=1e-8, atol=1e-9
    )
    columns = other.joint_torque_regressor(*motion)
    np.testing.assert_allclose(
        columns @ other.inertial_parameters.ravel(), other.inverse_dynamics(*motion), rtol=1e-8, atol=1e-9
    )
    with pytest.raises(ValueError, match=r"expected \(3,\)"):
        model.with_gravity(np.zeros(2))


def test_tilt_and_payload_together_are_the_loaded_arm_mounted_otherwise(robot: Robot, learned: tuple) -> None:
    """A log of the simulator is all there is: its arm has no file to write bodies and gravity into."""
    model, motion = learned[0], _motion(robot, 7, 6)
    tilt, body = {"theta_1": 0.2, "theta_2": -0.1}, {"m": 1.5, "cx": 0.02, "cy": -0.03, "cz": 0.08}
    body |= {"Ixx": 0.02, "Iyy": 0.02, "Izz": 0.02, "Ixy": 0.0, "Ixz": 0.0, "Iyz": 0.0}
    named = (NamedEffect("gravity_tilt", None, tilt), NamedEffect("payload", None, body))
    found = CorrectedModel(model, named, np.full(3, 0.02)).inverse_dynamics(*motion)
    mounted = model.with_gravity(effect_named("gravity_tilt").gravity_of(model.gravity, tilt))
    load = mounted.link_regressor(-1, *motion) @ effect_named("payload").coordinates(body)
    np.testing.assert_allclose(found, mounted.inverse_dynamics(*motion) + load, rtol=1e-8, atol=1e-8)


def test_saved_and_read_back_it_is_the_same(robot: Robot, learned: tuple, tmp_path) -> None:
    model = learned[0]
    folder = model.save(tmp_path / "model")
    again = load_serial_chain(folder, n_dof=3)
    assert isinstance(again, InverseDynamics)
    assert isinstance(again, SerialChain)
    assert again.joint_types == robot.joint_types
    assert isinstance(load_any(folder), SerialChain)
    motion = _motion(robot, 5, 8)
    np.testing.assert_array_equal(again.inverse_dynamics(*motion), model.inverse_dynamics(*motion))
    with pytest.raises(ModelError, match="joints"):
        load_serial_chain(folder, n_dof=6)
    said = json.loads((folder / "model.json").read_text())
    (folder / "model.json").write_text(json.dumps({**said, "version": 99}))
    with pytest.raises(ModelError, match="format"):
        load_serial_chain(folder)


@pytest.mark.slow
def test_shuffled_torque_is_not_explained(robot: Robot) -> None:
    q, v, a = _motion(robot, 200, 4)
    tau = np.random.default_rng(0).permutation(robot.inverse_dynamics(q, v, a))
    unknowns = Unknowns((True, False, True), (), (1.0, 1.0, 1.0))
    with jax.enable_x64(True):
        samples = make_samples(q, v, a, tau - tau.mean(axis=0), noise=tau.std(axis=0))
        settings = SearchSettings(least_starts=4, most_starts=4, iterations=10)
        found = search_axes(unknowns, samples, np.random.default_rng(1), settings)
    assert found.cost.min() > 0.8  # chance explains no more than its share of unknowns


@pytest.mark.slow
def test_friction_and_noise_are_told_from_the_arm(robot: Robot) -> None:
    q, v, a = _motion(robot, 1000, 2)
    clean = robot.inverse_dynamics(q, v, a)
    noise = 0.01 * clean.std(axis=0)
    tau = clean + 1.5 * v + 0.3 + noise * np.random.default_rng(1).normal(size=q.shape)
    settings = SerialChainSettings(joint_terms=("viscous_friction", "torque_offset"))
    model, found = learn_serial_chain(q, v, a, tau, robot.joints, robot.joint_types, 0, settings)
    np.testing.assert_allclose(found.noise, noise, rtol=0.15)
    np.testing.assert_allclose(found.coefficients[0], 1.5, rtol=0.1)
    assert np.all(is_physically_consistent(model.inertial_parameters))
    q = _motion(robot, 300, 77)[0]
    off = model.mass_matrix(q) - robot.mass_matrix(q)
    assert np.sum(off**2) < 1e-4 * np.sum(robot.mass_matrix(q) ** 2)


@pytest.mark.slow
def test_terms_that_torque_does_not_ask_for_are_dropped(robot: Robot, tmp_path: Path) -> None:
    q, v, a = _motion(robot, 400, 3)
    tau = robot.inverse_dynamics(q, v, a)
    settings = SerialChainSettings(joint_terms=("rotor_inertia", "viscous_friction", "coulomb_friction"))
    model, found = learn_serial_chain(q, v, a, tau, robot.joints, robot.joint_types, 0, settings)
    assert found.unknowns.joint_terms == ()
    assert not model.dynamics.lagrangian.rotor_inertia.any()
    again = load_serial_chain(model.save(tmp_path / "arm"))
    np.testing.assert_array_equal(again.inverse_dynamics(q, v, a), model.inverse_dynamics(q, v, a))


@pytest.mark.slow
def test_friction_reverses_as_sharply_as_it_was_recorded(robot: Robot) -> None:
    q, v, a = _motion(robot, 1000, 2)
    tau = robot.inverse_dynamics(q, v, a) + 2.0 * np.sign(v)
    settings = SerialChainSettings(joint_terms=("coulomb_friction",))
    model, _ = learn_serial_chain(q, v, a, tau, robot.joints, robot.joint_types, 0, settings)
    sharp = sharpen_reversals(model, q, v, a, tau)
    before, after = (np.sum((tau - arm.inverse_dynamics(q, v, a)) ** 2) for arm in (model, sharp))
    assert after < 0.2 * before
    assert np.all(sharp.dynamics.slow_speed < model.dynamics.slow_speed)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"joint_types": ("revolute", "screw", "revolute")}, "unknown"),
        ({"joint_types": ("revolute",)}, "shapes"),
        ({"rows": 10}, "too few"),
        ({"bad": np.nan}, "not finite"),
    ],
)
def test_bad_input_is_refused_in_one_sentence(robot: Robot, change: dict, message: str) -> None:
    q, v, a = _motion(robot, change.get("rows", 100), 0)
    tau = q.copy()
    tau[0, 0] = change.get("bad", 0.0)
    with pytest.raises(ModelError, match=message):
        fit_serial_chain(q, v, a, tau, change.get("joint_types", robot.joint_types))


def test_unknown_settings_are_refused() -> None:
    with pytest.raises(ModelError, match="unknown"):
        SerialChainSettings(joint_terms=("stiction",))
    with pytest.raises(ModelError, match="twice"):
        SerialChainSettings(joint_terms=("joint_spring", "joint_spring"))
    with pytest.raises(ModelError, match="at least one"):
        revolute_mask(())
