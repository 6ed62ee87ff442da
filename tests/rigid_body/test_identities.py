"""What holds of every arm of rigid bodies, on random arms with revolute, continuous, prismatic and fixed joints."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagnet.rigid_body.inertia import is_physically_consistent
from lagnet.rigid_body.random_arm import random_arm
from lagnet.types import InverseDynamics

IDENTITY = 1e-9  # two routes to the same number in float64, on torques of order 1 to 1e3
DIFFERENCE = 1e-5  # central differences at step 1e-6: truncation plus rounding, relative to the size
STEP = 1e-6
SAMPLES = 6

arms = st.builds(random_arm, st.integers(1, 8), st.integers(0, 2**31))
few = settings(max_examples=15, deadline=None)


def motion(robot, seed=0, n=SAMPLES, arrays=3):
    return np.random.default_rng(seed).normal(size=(arrays, n, robot.n_dof))


def scale(*arrays):
    return 1.0 + max(np.abs(array).max() for array in arrays)


def times(matrices, vectors):
    return np.einsum("nij,nj->ni", matrices, vectors)


@given(arms)
@few
def test_torque_is_the_sum_of_its_terms(robot):
    q, v, a = motion(robot)
    tau = robot.inverse_dynamics(q, v, a)
    terms = times(robot.mass_matrix(q), a) + robot.coriolis_torque(q, v) + robot.gravity_torque(q)
    assert np.abs(tau - terms).max() < IDENTITY * scale(tau)


@given(arms)
@few
def test_torque_derivatives_are_those_of_the_torque(robot):
    q, v, a = motion(robot)
    found = robot.torque_derivatives(q, v, a)
    for joint, step in enumerate(STEP * np.eye(robot.n_dof)):
        for k, (dq, dv, da) in enumerate(step * np.eye(3)[:, :, None]):
            ahead, behind = (robot.inverse_dynamics(q + s * dq, v + s * dv, a + s * da) for s in (1.0, -1.0))
            expected = (ahead - behind) / (2 * STEP)
            assert np.abs(found[k, :, :, joint] - expected).max() < DIFFERENCE * scale(ahead)
    assert np.abs(found[2] - robot.mass_matrix(q)).max() < IDENTITY * scale(found[2])


@given(arms)
@few
def test_mass_matrix_is_symmetric_and_positive_definite(robot):
    mass = robot.mass_matrix(motion(robot)[0])
    assert np.array_equal(mass, mass.transpose(0, 2, 1))
    assert np.linalg.eigvalsh(mass).min() > 0


@given(arms)
@few
def test_mass_matrix_changes_by_the_coriolis_matrix_and_its_transpose(robot):
    q, v, _ = motion(robot)
    rate = (robot.mass_matrix(q + STEP * v) - robot.mass_matrix(q - STEP * v)) / (2 * STEP)
    coriolis = robot.coriolis_matrix(q, v)
    assert np.abs(rate - coriolis - coriolis.transpose(0, 2, 1)).max() < DIFFERENCE * scale(rate)


@given(arms)
@few
def test_coriolis_matrix_is_made_of_christoffel_symbols(robot):
    q, v, _ = motion(robot, n=2)
    moves = np.eye(robot.n_dof) * STEP
    slopes = [(robot.mass_matrix(q + e) - robot.mass_matrix(q - e)) / (2 * STEP) for e in moves]
    d = np.stack(slopes, axis=-1)  # d[n, i, j, k] = ∂M_ij / ∂q_k
    symbols = 0.5 * (d + d.transpose(0, 1, 3, 2) - d.transpose(0, 3, 2, 1))
    expected = np.einsum("nijk,nk->nij", symbols, v)
    assert np.abs(robot.coriolis_matrix(q, v) - expected).max() < DIFFERENCE * scale(expected)


@given(arms)
@few
def test_coriolis_torque_is_the_matrix_times_velocity_and_quadratic(robot):
    q, v, _ = motion(robot)
    torque = robot.coriolis_torque(q, v)
    assert np.abs(times(robot.coriolis_matrix(q, v), v) - torque).max() < IDENTITY * scale(torque)
    assert np.abs(robot.coriolis_torque(q, -2 * v) - 4 * torque).max() < IDENTITY * scale(4 * torque)
    assert np.abs(robot.coriolis_torque(q, 0 * v)).max() < IDENTITY


@given(arms)
@few
def test_forward_dynamics_undoes_inverse_dynamics(robot):
    q, v, a = motion(robot)
    tau = robot.inverse_dynamics(q, v, a)
    # the error of a solve grows with the condition of the mass matrix
    tolerance = 1e-12 * max(1e3, float(np.linalg.cond(robot.mass_matrix(q)).max())) * scale(tau)
    assert np.abs(robot.forward_dynamics(q, v, tau) - a).max() < tolerance


@given(arms)
@few
def test_regressor_times_parameters_is_the_torque(robot):
    q, v, a = motion(robot)
    tau, parameters = robot.inverse_dynamics(q, v, a), robot.inertial_parameters()
    regressor = robot.joint_torque_regressor(q, v, a)
    assert regressor.shape == (SAMPLES, robot.n_dof, 10 * robot.n_dof)
    assert np.abs(regressor @ parameters.ravel() - tau).max() < IDENTITY * scale(tau)
    by_link = [robot.link_regressor(k, q, v, a) for k in range(robot.n_dof)]
    assert np.array_equal(np.concatenate(by_link, axis=2), regressor)
    chunks = list(robot.regressor_chunks(q, v, a, chunk=4))
    assert [rows for rows, _ in chunks] == [slice(0, 4), slice(4, 6)]
    assert np.array_equal(np.concatenate([part for _, part in chunks]), regressor)


@given(arms)
@few
def test_gravity_is_linear_in_the_gravity_vector(robot):
    q = motion(robot)[0]
    columns = robot.gravity_regressor(q)
    assert np.abs(columns @ robot.gravity - robot.gravity_torque(q)).max() < IDENTITY * scale(columns) * 10
    tilted = robot.with_gravity(np.array([1.0, -2.0, 3.0]))
    assert np.abs(columns @ tilted.gravity - tilted.gravity_torque(q)).max() < IDENTITY * scale(columns) * 10
    assert np.array_equal(robot.gravity, [0, 0, -9.81]), "the original must not change"


@given(arms)
@few
def test_weight_of_each_body_is_its_regressor_at_rest_in_a_field_along_each_axis(robot):
    q = motion(robot)[0]
    still = np.zeros_like(q)
    for joint in (*range(robot.n_dof), -1):
        fields = [robot.with_gravity(g).link_regressor(joint, q, still, still) for g in np.eye(3)]
        weights = robot.weight_regressor(joint, q)
        assert np.abs(weights - fields).max() < IDENTITY * scale(np.array(fields))


@given(arms)
@few
def test_gravity_torque_is_the_slope_of_potential_energy(robot):
    q = motion(robot)[0]
    moves = np.eye(robot.n_dof) * STEP
    slope = [(robot.potential_energy(q + e) - robot.potential_energy(q - e)) / (2 * STEP) for e in moves]
    assert np.abs(np.stack(slope, axis=1) - robot.gravity_torque(q)).max() < DIFFERENCE * scale(*slope)


@given(arms)
@few
def test_power_of_the_torques_is_the_rate_of_energy(robot):
    q, v, a = motion(robot)

    def energy(t):
        return robot.kinetic_energy(q + v * t, v + a * t) + robot.potential_energy(q + v * t)

    rate = (energy(STEP) - energy(-STEP)) / (2 * STEP)
    power = np.sum(robot.inverse_dynamics(q, v, a) * v, axis=1)
    assert np.abs(rate - power).max() < 10 * DIFFERENCE * scale(power)


@given(arms)
@few
def test_kinetic_energy_is_half_the_mass_matrix_between_velocities(robot):
    q, v, _ = motion(robot)
    expected = 0.5 * np.einsum("ni,nij,nj->n", v, robot.mass_matrix(q), v)
    assert np.abs(robot.kinetic_energy(q, v) - expected).max() < IDENTITY * scale(expected)


@given(arms)
@few
def test_wrench_regressor_is_the_power_of_a_force_at_the_tip(robot):
    q = motion(robot)[0]
    columns = robot.wrench_regressor(q)
    moves = np.eye(robot.n_dof) * STEP
    for i in range(2):
        slope = [(robot.skeleton(q[i] + e)[-1] - robot.skeleton(q[i] - e)[-1]) / (2 * STEP) for e in moves]
        assert np.abs(columns[i][:, :3] + np.array(slope)).max() < DIFFERENCE * scale(columns)


@given(arms, st.integers(0, 2**31))
@few
def test_payload_adds_the_regressor_of_its_link(robot, seed):
    q, v, a = motion(robot, seed)
    loaded = robot.with_payload(1.5, np.array([0.1, -0.05, 0.2]), np.diag([0.01, 0.02, 0.015]))
    added = (loaded.inertial_parameters() - robot.inertial_parameters())[-1]
    expected = robot.link_regressor(-1, q, v, a) @ added
    change = loaded.inverse_dynamics(q, v, a) - robot.inverse_dynamics(q, v, a)
    assert np.abs(change - expected).max() < IDENTITY * scale(robot.inverse_dynamics(q, v, a))
    assert added[0] == pytest.approx(1.5)


@given(arms)
@few
def test_parameters_go_in_and_come_out(robot):
    q, v, a = motion(robot)
    parameters = robot.inertial_parameters()
    assert is_physically_consistent(parameters).all()
    changed = parameters * np.array([1.1, *[0.9] * 9])
    other = robot.with_inertial_parameters(changed)
    assert np.abs(other.inertial_parameters() - changed).max() < IDENTITY
    tau = other.inverse_dynamics(q, v, a)
    assert np.abs(robot.joint_torque_regressor(q, v, a) @ changed.ravel() - tau).max() < IDENTITY * scale(tau)
    assert np.array_equal(robot.inertial_parameters(), parameters), "the original must not change"


@given(arms)
@few
def test_a_random_arm_answers_the_protocol_and_is_drawn_again_by_its_seed(robot):
    assert isinstance(robot, InverseDynamics)
    assert robot.warnings == ()


def test_the_same_seed_gives_the_same_arm():
    first, second = random_arm(5, 7), random_arm(5, 7)
    assert np.array_equal(first.inertial_parameters(), second.inertial_parameters())
    assert not np.array_equal(first.inertial_parameters(), random_arm(5, 8).inertial_parameters())
    assert set(random_arm(8, 0, kinds=("prismatic",)).joint_types) == {"prismatic"}
    with pytest.raises(ValueError, match="at least 1"):
        random_arm(0, 0)
