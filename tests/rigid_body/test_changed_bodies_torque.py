"""Torque of a change of bodies is the regressor times that change, whether or not it is a real body."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.rigid_body.changed_bodies_torque import derivatives_of_change, torque_of_change
from lagnet.rigid_body.inertia import parameters_of_body, tensor_about_com
from lagnet.rigid_body.random_arm import random_arm

N, SAMPLES = 4, 30
CHANGES = {
    "none": lambda g: np.zeros((N, 10)),
    "any": lambda g: g.normal(size=(N, 10)),
    "first moments alone": lambda g: np.eye(10)[1:4].sum(axis=0) * g.normal(size=(N, 1)),
    "inertia alone": lambda g: np.eye(10)[4:].sum(axis=0) * g.normal(size=(N, 1)),
    "masses taken off": lambda g: -5.0 * np.eye(10)[0] * np.ones((N, 1)),
    "hardly a mass": lambda g: np.r_[1e-9, g.normal(size=9)] * np.ones((N, 1)),
}


class WithoutNewtonEuler:
    """A model of which the regressor alone is known, and what was asked of it."""

    def __init__(self, robot) -> None:
        self._robot, self.largest = robot, 0

    def joint_torque_regressor(self, q, v, a):
        self.largest = max(self.largest, len(q))
        return self._robot.joint_torque_regressor(q, v, a)


def motion(n: int = SAMPLES):
    g = np.random.default_rng(1)
    return g.normal(size=(n, N)), g.normal(size=(n, N)), g.normal(size=(n, N))


@pytest.mark.parametrize("make", CHANGES.values(), ids=CHANGES)
@pytest.mark.parametrize("kinds", [("revolute",), ("revolute", "prismatic")])
def test_it_is_the_regressor_times_the_change(make, kinds) -> None:
    robot = random_arm(N, seed=3, kinds=kinds).with_armature(np.full(N, 0.3))
    change = make(np.random.default_rng(0))
    expected = robot.joint_torque_regressor(*motion()) @ change.ravel()
    np.testing.assert_allclose(torque_of_change(robot, change, *motion()), expected, rtol=1e-9, atol=1e-10)


@pytest.mark.parametrize("make", CHANGES.values(), ids=CHANGES)
def test_its_derivatives_are_those_of_its_torque(make) -> None:
    robot = random_arm(N, seed=3).with_armature(np.full(N, 0.3))
    change, step, signals = make(np.random.default_rng(0)), 1e-5, motion()
    found = derivatives_of_change(robot, change, *signals)
    for k in range(3):
        for joint, unit in enumerate(np.eye(N)):
            ends = [[x + (i == k) * s * unit for i, x in enumerate(signals)] for s in (step, -step)]
            ahead, behind = (torque_of_change(robot, change, *end) for end in ends)
            expected = (ahead - behind) / (2.0 * step)
            np.testing.assert_allclose(found[k, :, :, joint], expected, atol=1e-6 * (1.0 + np.abs(ahead).max()))


def test_of_a_model_that_is_no_robot_the_regressor_is_asked_in_pieces() -> None:
    robot, change = random_arm(N, seed=3), np.random.default_rng(0).normal(size=(N, 10))
    asked = WithoutNewtonEuler(robot)
    found = torque_of_change(asked, change, *motion(9000))
    np.testing.assert_allclose(found, torque_of_change(robot, change, *motion(9000)), rtol=1e-9, atol=1e-9)
    assert asked.largest < 5000


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_thin_rod_has_its_torque_however_its_tensor_is_rounded(axis) -> None:
    """A rod along one axis has no inertia about that axis, or 1e-18 kg m² less."""
    robot, g, odd = random_arm(N, seed=3), np.random.default_rng(axis), 0
    for _ in range(300):
        ends = g.normal(size=3) + np.outer([-1.0, 1.0], np.eye(3)[axis] * g.uniform(0.01, 1.0))
        rod = sum(
            parameters_of_body(m, end, np.zeros((3, 3))) for m, end in zip(g.uniform(0.1, 5.0, 2), ends, strict=True)
        )
        odd += tensor_about_com(rod)[axis, axis] < 0.0
        change = np.outer(np.eye(N)[-1], rod)
        expected = robot.joint_torque_regressor(*motion(2)) @ change.ravel()
        np.testing.assert_allclose(
            robot.with_inertial_parameters(change).inverse_dynamics(*motion(2)), expected, rtol=1e-9, atol=1e-9
        )
    assert odd > 10


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_moment_of_inertia_below_zero_is_refused(axis) -> None:
    tensor = np.diag(np.where(np.arange(3) == axis, -1e-6, 0.1))
    body = parameters_of_body(2.0, np.array([0.1, 0.2, 0.3]), tensor)
    with pytest.raises(ValueError, match="has -1e-06 kg m² about its centre of mass"):
        random_arm(N, seed=3).with_inertial_parameters(np.outer(np.eye(N)[-1], body))
