"""An independent engine gives the same torques, also for files that were written back."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import load_description

pybullet = pytest.importorskip("pybullet")
AGREEMENT = 1e-10  # of the largest torque: two engines, the same Newton-Euler in float64


def torques_of_pybullet(path, q, v, a):
    client = pybullet.connect(pybullet.DIRECT)
    try:
        pybullet.setGravity(0, 0, -9.81, physicsClientId=client)
        flags = pybullet.URDF_USE_INERTIA_FROM_FILE
        body = pybullet.loadURDF(str(path), useFixedBase=True, flags=flags, physicsClientId=client)
        rows = [
            pybullet.calculateInverseDynamics(body, list(q[i]), list(v[i]), list(a[i]), physicsClientId=client)
            for i in range(len(q))
        ]
    finally:
        pybullet.disconnect(client)
    return np.array(rows)


def check(robot, path):
    q, v, a = np.random.default_rng(1).normal(size=(3, 50, robot.n_dof))
    tau = robot.inverse_dynamics(q, v, a)
    assert np.abs(torques_of_pybullet(path, q, v, a) - tau).max() < AGREEMENT * np.abs(tau).max()


@pytest.mark.parametrize("name", ["ur5", "panda", "xarm7", "kinova"])
def test_named_robots_agree(name, tmp_path):
    robot = load_description(name)
    robot.write_bare_urdf(tmp_path / "arm.urdf")
    check(robot, tmp_path / "arm.urdf")


@pytest.mark.parametrize("seed", range(4))
def test_random_arms_with_fixed_links_agree_after_a_payload_was_written_back(seed, tmp_path):
    robot = random_arm(5, seed).with_payload(2.0, np.array([0.05, 0.0, 0.1]), np.eye(3) * 0.01)
    robot.write_urdf(tmp_path / "arm.urdf")  # with the welded links, whose inertials are zero now
    check(robot, tmp_path / "arm.urdf")


@pytest.mark.parametrize("file", ["ur10e/ur10e.urdf", "staubli_tx40/tx40.urdf", "emps/emps.urdf"])
def test_real_robots_agree_once_written_back(file, shared_data, tmp_path):
    # as they are, PyBullet gives every link without an inertial (ee_link, tool0) a mass of 1 kg
    robot = load_description(shared_data / file)
    robot.write_urdf(tmp_path / "arm.urdf")
    check(robot, tmp_path / "arm.urdf")
