"""The combinations that a motion can show: their number, and that they carry the whole torque."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagnet.rigid_body.base_parameters import base_parameters
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import load_description

IDENTITY = 1e-9  # relative to the largest torque


# 36 for a UR-like arm with a vertical first axis (Gautier 1991), 43 for seven revolute joints
@pytest.mark.parametrize(("name", "rank"), [("ur5", 36), ("ur10", 36), ("panda", 43), ("xarm7", 43)])
def test_known_arms_have_the_known_number(name, rank):
    assert base_parameters(load_description(name)).rank == rank
    assert base_parameters(load_description(name), seed=5).rank == rank


def test_a_slide_shows_its_mass_alone(shared_data):
    found = base_parameters(load_description(shared_data / "emps" / "emps.urdf"))
    assert found.describe() == ("m(slide)",)
    assert list(found.unidentifiable) == list(range(1, 10))


@given(st.integers(1, 6), st.integers(0, 2**31))
@settings(max_examples=15, deadline=None)
def test_base_parameters_carry_the_whole_torque(n_joints, seed):
    robot = random_arm(n_joints, seed)
    found, parameters = base_parameters(robot), robot.inertial_parameters()
    q, v, a = np.random.default_rng(seed).normal(size=(3, 20, n_joints))
    regressor, tau = robot.joint_torque_regressor(q, v, a), robot.inverse_dynamics(q, v, a)
    tolerance = IDENTITY * (1 + np.abs(tau).max())
    beta = found.of(parameters)
    assert beta.shape == (found.rank,)
    assert np.abs(found.reduce(regressor) @ beta - tau).max() < tolerance
    other = found.nearest(beta, np.ones_like(parameters))
    assert np.abs(regressor @ other.ravel() - tau).max() < 10 * tolerance
    assert np.linalg.norm(other - 1) <= np.linalg.norm(parameters - 1) + 1e-9, "nearest to the prior"
    assert np.allclose(found.nearest(beta, parameters), parameters, atol=1e-9), "a prior that fits is kept"


@given(st.integers(1, 5), st.integers(0, 2**31))
@settings(max_examples=10, deadline=None)
def test_the_columns_kept_are_independent(n_joints, seed):
    robot = random_arm(n_joints, seed)
    found = base_parameters(robot)
    q, v, a = np.random.default_rng(seed).normal(size=(3, 200, n_joints)) * 2
    columns = found.reduce(robot.joint_torque_regressor(q, v, a)).reshape(-1, found.rank)
    assert np.linalg.matrix_rank(columns / np.linalg.norm(columns, axis=0), tol=1e-6) == found.rank
    assert sorted([*found.independent, *found.dependent]) == list(range(10 * n_joints))
    assert len(found.describe()) == found.rank
