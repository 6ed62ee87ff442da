"""Damping of the engine acts on motion, and on nothing that is computed from a state."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.rigid_body.robot import load_description
from lagnet.simulation.pybullet_arm import PyBulletArm

STEP = 1e-3
IDENTITY = 1e-9  # of the largest entry: the same arithmetic twice
LOST = 1.5  # N m s/rad


def test_joint_damping_takes_torque_in_proportion_to_speed() -> None:
    robot = load_description("ur5")
    rng = np.random.default_rng(0)
    q, v, tau = rng.uniform(-2, 2, 6), rng.normal(size=6), rng.normal(size=6)
    with PyBulletArm(robot, STEP) as arm:
        bias, mass = arm.bias_torque(q, v), arm.mass_matrix(q)
        arm.damp(0.0, 0.0, LOST)
        np.testing.assert_allclose(arm.bias_torque(q, v), bias, atol=IDENTITY * np.abs(bias).max())
        arm.put(q, v)
        arm.advance(tau)
        rate = (arm.state()[1] - v) / STEP
    np.testing.assert_allclose(tau - bias - mass @ rate, LOST * v, rtol=1e-6)


@pytest.mark.parametrize("way", [{"linear": 0.5, "angular": 0.0}, {"linear": 0.0, "angular": 0.5}])
def test_damping_of_bodies_takes_energy(way: dict[str, float]) -> None:
    robot = load_description("ur5")
    rng = np.random.default_rng(1)
    q, v = rng.uniform(-2, 2, 6), rng.normal(size=6)
    with PyBulletArm(robot, STEP) as arm:
        bias = arm.bias_torque(q, v)
        arm.damp(**way, joint=0.0)
        arm.put(q, v)
        arm.advance(bias)
        lost = arm.mass_matrix(q) @ (arm.state()[1] - v)
    assert v @ lost < 0
