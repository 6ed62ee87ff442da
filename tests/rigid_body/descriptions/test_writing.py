"""An arm written to a file and read again is the same arm."""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np
import pytest

from lagnet.errors import RobotError
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import load_description

ORACLE = 1e-8  # relative to the largest torque; the digits written lose nothing
ARMS = ["ur5", "panda", "z1", "kinova", "xarm7", "ur10", 1, 2, 3, 4, 5, 6]
FORMATS = ["urdf", "bare_urdf", "mjcf"]


def arm(spec):
    return load_description(spec) if isinstance(spec, str) else random_arm(spec, seed=spec)


def same_torques(first, second):
    q, v, a = np.random.default_rng(0).normal(size=(3, 20, first.n_dof))
    expected = first.inverse_dynamics(q, v, a)
    return np.abs(second.inverse_dynamics(q, v, a) - expected).max() < ORACLE * np.abs(expected).max()


@pytest.mark.parametrize("spec", ARMS)
@pytest.mark.parametrize("form", FORMATS)
def test_a_loaded_arm_comes_back(spec, form, tmp_path):
    robot = arm(spec).with_payload(2.0, np.array([0.1, 0.02, 0.03]), np.diag([0.01, 0.02, 0.015]))
    path = tmp_path / "made" / ("arm.xml" if form == "mjcf" else "arm.urdf")
    getattr(robot, f"write_{form}")(path)
    back = load_description(path)
    assert (back.joints, back.joint_types, back.links) == (robot.joints, robot.joint_types, robot.links)
    assert back.position_lower == pytest.approx(robot.position_lower)
    assert back.position_upper == pytest.approx(robot.position_upper)
    if form != "mjcf":
        assert back.velocity_limit == pytest.approx(robot.velocity_limit)
        assert back.effort_limit == pytest.approx(robot.effort_limit)
    assert same_torques(robot, back)
    assert [p.name for p in path.parent.iterdir()] == [path.name], "no half-written file is left"


def test_mjcf_keeps_gravity_and_rotor_inertia(tmp_path):
    (tmp_path / "a.xml").write_text(
        '<mujoco><worldbody><body name="b"><joint name="h" axis="0 1 0" armature="0.3"/>'
        '<inertial pos="0 0 .2" mass="1" diaginertia="1 1 1"/></body></worldbody></mujoco>'
    )
    robot = load_description(tmp_path / "a.xml").with_gravity(np.array([1.0, 0.0, -9.0]))
    robot.write_mjcf(tmp_path / "b.xml")
    back = load_description(tmp_path / "b.xml")
    assert same_torques(robot, back)
    assert back.gravity == pytest.approx([1, 0, -9])
    with pytest.raises(RobotError, match="rotor inertias"):
        robot.write_urdf(tmp_path / "c.urdf")
    assert not (tmp_path / "c.urdf").exists()


def test_mjcf_without_rotor_inertia_is_written_as_urdf(tmp_path):
    robot = random_arm(4, 9)
    robot.write_mjcf(tmp_path / "a.xml")
    load_description(tmp_path / "a.xml").write_urdf(tmp_path / "b.urdf")
    assert same_torques(robot, load_description(tmp_path / "b.urdf"))


def test_only_inertials_and_held_joints_change_in_a_urdf(tmp_path):
    robot = load_description("panda")
    robot.write_urdf(tmp_path / "arm.urdf")
    before, after = robot._description.file.root(), ElementTree.parse(tmp_path / "arm.urdf").getroot()
    for tag in ("visual", "collision", "limit", "axis"):
        assert [e.attrib for e in before.iter(tag)] == [e.attrib for e in after.iter(tag)]
    changed = [
        (old.get("name"), new.get("type"))
        for old, new in zip(before.findall("joint"), after.findall("joint"), strict=True)
        if old.get("type") != new.get("type")
    ]
    assert changed == [("panda_finger_joint1", "fixed"), ("panda_finger_joint2", "fixed")]


def test_welded_links_carry_an_explicit_zero(tmp_path):
    robot = load_description("ur5")
    robot.write_urdf(tmp_path / "arm.urdf")
    masses = {
        link.get("name"): link.find("inertial/mass")
        for link in ElementTree.parse(tmp_path / "arm.urdf").getroot().findall("link")
    }
    assert masses["tool0"].get("value") == masses["ee_link"].get("value") == "0.0"
    assert float(masses["wrist_3_link"].get("value")) == pytest.approx(0.1879)


def test_held_mimic_joints_are_written_where_they_are_held(tmp_path):
    text = random_arm(2, 5, kinds=("revolute",))._description.file.text.decode()
    text = text.replace("</joint>", '<mimic joint="joint_0" offset="0.4"/></joint>').replace(
        '<mimic joint="joint_0" offset="0.4"/></joint>', "</joint>", 1
    )
    (tmp_path / "a.urdf").write_text(text)
    robot = load_description(tmp_path / "a.urdf")
    assert robot.joints == ("joint_0",)
    robot.write_urdf(tmp_path / "b.urdf")
    assert same_torques(robot, load_description(tmp_path / "b.urdf"))
