"""A URDF without inertials is read, since recordings can tell what it lacks; torque cannot move it, and it says so."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest

from lagnet.cli.main import main
from lagnet.errors import RobotError
from lagnet.rigid_body.descriptions.mass_checks import KINEMATICS_ALONE
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import Robot, load_description
from lagnet.simulation.pybullet_arm import PyBulletArm
from lagnet.simulators.corrected_arm.arm_physics import arm_physics

ARM = random_arm(3, seed=12, kinds=("revolute",), fixed=False)
REFUSED = "nothing behind joint joint_{} has mass; give link .* an inertial, or make the joint fixed"


def without_inertials(folder: Path, *links: str) -> Robot:
    """The arm's file without the inertials of some links, all of them where none is told."""
    path = folder / "arm.urdf"
    ARM.write_urdf(path)
    tree = ElementTree.parse(path)
    for link in tree.getroot().iter("link"):
        for inertial in link.findall("inertial"):
            if not links or link.get("name") in links:
                link.remove(inertial)
    tree.write(path)
    return load_description(path)


def test_it_is_read_with_its_kinematics_and_a_warning(tmp_path) -> None:
    robot = without_inertials(tmp_path)
    assert robot.warnings == (KINEMATICS_ALONE,)
    assert not robot.has_mass
    q, v, a = np.random.default_rng(0).normal(size=(3, 5, 3))
    np.testing.assert_array_equal(robot.inverse_dynamics(q, v, a), 0.0)
    np.testing.assert_allclose(robot.joint_torque_regressor(q, v, a), ARM.joint_torque_regressor(q, v, a), atol=1e-9)


def test_inertials_of_zeros_are_none(tmp_path) -> None:
    ARM.with_inertial_parameters(np.zeros((3, 10))).write_urdf(tmp_path / "arm.urdf")
    assert "<mass" in (tmp_path / "arm.urdf").read_text()
    robot = load_description(tmp_path / "arm.urdf")
    assert robot.warnings == (KINEMATICS_ALONE,)
    assert not robot.can_move


def test_torque_cannot_move_it(tmp_path) -> None:
    robot, still = without_inertials(tmp_path), np.zeros((1, 3))
    assert not robot.can_move
    for asked in (
        lambda: robot.forward_dynamics(still, still, still + 1.0),
        lambda: PyBulletArm(robot, 1e-3),
        lambda: arm_physics(robot),
    ):
        with pytest.raises(RobotError, match=REFUSED.format(0)):
            asked()


def test_a_last_link_without_mass_is_told_and_cannot_be_moved(tmp_path) -> None:
    robot = without_inertials(tmp_path, ARM.links[-1])
    assert robot.has_mass
    assert re.search("behind joint joint_2 has a mass of 0 kg", robot.warnings[0])
    assert "feels no inertia" in robot.warnings[1]
    with pytest.raises(RobotError, match=REFUSED.format(2)):
        arm_physics(robot)


def test_a_middle_link_without_mass_moves_with_what_it_carries(tmp_path) -> None:
    robot, still = without_inertials(tmp_path, ARM.links[1]), np.zeros((1, 3))
    assert robot.can_move
    assert np.isfinite(robot.forward_dynamics(still, still, still + 1.0)).all()


def test_simulate_refuses_it_in_one_line(tmp_path, capsys) -> None:
    without_inertials(tmp_path)
    words = ["simulate", "--robot", str(tmp_path / "arm.urdf"), "--out", str(tmp_path / "out")]
    assert main(words) == 2
    assert re.search(REFUSED.format(0), capsys.readouterr().err)
    assert not (tmp_path / "out").exists()
