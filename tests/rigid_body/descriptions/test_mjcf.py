"""MJCF: read like the same arm in URDF, and refused where it would open files or is no arm of simple joints."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from lagnet.errors import RobotError
from lagnet.rigid_body.inertia import tensor_about_com
from lagnet.rigid_body.robot import load_description

ARM = """<mujoco model="arm"><compiler angle="degree"/><option gravity="0 0 -9.8"/>
<asset><mesh name="m" file="{mesh}"/></asset><worldbody><geom type="plane" size="1 1 1"/>
<body name="upper" pos="0 0 0.3" euler="0 90 0"><joint name="swing" type="hinge" axis="0 0 1" range="-90 90"
 limited="true" armature="0.2" damping="{damping}"/>
<inertial pos="0 0 .1" mass="2" diaginertia=".02 .02 .01"/><geom type="mesh" mesh="m"/>
<body name="slider" pos="0 .1 .3"><joint name="slide" type="slide" axis="0 1 1"/>
<inertial pos="0 0 .1" mass="1.5" fullinertia=".02 .03 .04 0 0.005 0"/>
<body name="tool" pos="0 0 .2"><inertial pos="0 0 .1" mass="0.5" diaginertia=".01 .01 .01"/></body></body></body>
</worldbody><actuator><motor joint="swing"/></actuator></mujoco>"""
URDF = """<robot name="arm"><link name="base"/>
<link name="upper"><inertial><origin xyz="0 0 .1"/><mass value="2"/>
<inertia ixx=".02" iyy=".02" izz=".01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="swing" type="revolute"><origin xyz="0 0 0.3" rpy="0 1.5707963267948966 0"/><parent link="base"/>
<child link="upper"/><axis xyz="0 0 1"/><limit lower="-1.5707963267948966" upper="1.5707963267948966"/></joint>
<link name="slider"><inertial><origin xyz="0 0 .1"/><mass value="1.5"/>
<inertia ixx=".02" iyy=".03" izz=".04" ixy="0" ixz=".005" iyz="0"/></inertial></link>
<joint name="slide" type="prismatic"><origin xyz="0 .1 .3"/><parent link="upper"/><child link="slider"/>
<axis xyz="0 1 1"/></joint>
<link name="tool"><inertial><origin xyz="0 0 .1"/><mass value="0.5"/>
<inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="weld" type="fixed"><origin xyz="0 0 .2"/><parent link="slider"/><child link="tool"/></joint></robot>"""
SAME = 1e-9  # two files of one arm, relative to the largest torque


@pytest.fixture
def arm(tmp_path):
    (tmp_path / "arm.xml").write_text(ARM.format(mesh="/dev/zero", damping="3"))
    return load_description(tmp_path / "arm.xml")


def test_the_same_arm_in_urdf_gives_the_same_torques(arm, tmp_path):
    (tmp_path / "arm.urdf").write_text(URDF)
    urdf = load_description(tmp_path / "arm.urdf").with_gravity(np.array([0, 0, -9.8]))
    q, v, a = np.random.default_rng(0).normal(size=(3, 20, 2))
    expected = urdf.inverse_dynamics(q, v, a) + np.array([0.2, 0.0]) * a  # a URDF knows no rotor inertia
    assert np.abs(arm.inverse_dynamics(q, v, a) - expected).max() < SAME * np.abs(expected).max()
    assert np.abs(arm.forward_dynamics(q, v, expected) - a).max() < SAME * 10


def test_joints_limits_and_what_is_left_out_are_read(arm):
    assert (arm.kind, arm.joints, arm.links) == ("mjcf", ("swing", "slide"), ("upper", "slider"))
    assert arm.joint_types == ("revolute", "prismatic")
    assert arm.position_upper == pytest.approx([np.pi / 2, np.inf])
    assert arm.armature == pytest.approx([0.2, 0])
    assert arm.gravity == pytest.approx([0, 0, -9.8])
    assert any("declared on swing" in warning for warning in arm.warnings)


def test_rotor_inertia_stands_beside_the_regressor(arm):
    q, v, a = np.random.default_rng(0).normal(size=(3, 20, 2))
    bodies = arm.joint_torque_regressor(q, v, a) @ arm.inertial_parameters().ravel()
    assert np.abs(bodies + arm.armature * a - arm.inverse_dynamics(q, v, a)).max() < SAME * 100
    kinetic = 0.5 * np.einsum("ni,nij,nj->n", v, arm.mass_matrix(q), v)
    assert np.abs(arm.kinetic_energy(q, v) - kinetic).max() < SAME * 10


MADE_OF_SHAPES = """<mujoco><compiler inertiafromgeom="true"/><worldbody><body name="b"><joint name="h" axis="0 1 0"/>
<inertial pos="0 0 0" mass="9" diaginertia="1 1 1"/><geom type="{0}" size="{1}" density="500" pos="0 0 0.5"/></body>
</worldbody></mujoco>"""
SHAPES = {  # mass and moments about the centre, by the textbook; density 500
    "box": ("0.1 0.2 0.3", 24.0, 24 / 3 * np.array([0.2**2 + 0.3**2, 0.1**2 + 0.3**2, 0.1**2 + 0.2**2])),
    "cylinder": ("0.1 0.2", 2 * np.pi, 2 * np.pi * np.array([0.01 / 4 + 0.16 / 12, 0.01 / 4 + 0.16 / 12, 0.01 / 2])),
    "sphere": ("0.1", 2 / 3 * np.pi, 2 / 3 * np.pi * 0.4 * 0.01 * np.ones(3)),
}


@pytest.mark.parametrize("shape", SHAPES)
def test_bodies_made_of_shapes_have_the_inertia_of_the_textbook(shape, tmp_path):
    size, mass, moments = SHAPES[shape]
    (tmp_path / "arm.xml").write_text(MADE_OF_SHAPES.format(shape, size))
    parameters = load_description(tmp_path / "arm.xml").inertial_parameters()[0]
    assert parameters[0] == pytest.approx(mass)
    assert parameters[1:4] == pytest.approx([0, 0, 0.5 * mass])
    assert np.diag(tensor_about_com(parameters)) == pytest.approx(moments)


def body(inside, head=""):
    return f'<mujoco>{head}<worldbody><body name="b">{inside}</body></worldbody></mujoco>'


INERTIAL = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
HINGE = '<joint name="h" type="hinge"/>'
BAD = {
    "include": (body(HINGE + INERTIAL, '<include file="/etc/passwd"/>'), "<include> is refused"),
    "nested include": (body(HINGE + INERTIAL + '<include file="other.xml"/>'), "<include> is refused"),
    "plugin": (body(HINGE + INERTIAL, '<extension><plugin plugin="x"/></extension>'), "<plugin> is refused"),
    "doctype": ('<!DOCTYPE mujoco [<!ENTITY a "b">]>' + body(HINGE + INERTIAL), "document type"),
    "free": (body("<freejoint/>" + INERTIAL), "'free', which has no single position"),
    "ball": (body('<joint name="h" type="ball"/>' + INERTIAL), "joint h of body b is of type 'ball'"),
    "ball by default": (
        body('<joint name="h"/>' + INERTIAL, '<default><joint type="ball"/></default>'),
        "joint h of body b is of type 'ball'",
    ),
    "two joints": (body(HINGE + HINGE.replace('"h"', '"i"') + INERTIAL), "body b has 2 joints"),
    "mesh without inertial": (
        body(HINGE + '<geom type="mesh" mesh="m"/>'),
        "body b has a shape of type 'mesh' and no <inertial>",
    ),
    "inertia from no shapes": (body(HINGE + INERTIAL, '<compiler inertiafromgeom="true"/>'), "nothing behind joint h"),
    "no body": ("<mujoco><worldbody/></mujoco>", "no moving joint"),
    "too many numbers": (body(HINGE.replace("/>", ' axis="0 0 1 0"/>') + INERTIAL), "axis='0 0 1 0' has 4 numbers"),
    "unknown class": (body(HINGE.replace("/>", ' class="x"/>') + INERTIAL), "unknown class 'x'"),
    "twins": (body(HINGE + INERTIAL + '<body name="b"/>'), "two bodies are named b"),
    "global frames": (body(HINGE + INERTIAL, '<compiler coordinate="global"/>'), "compiler coordinate='global'"),
    "no inertia": (body(HINGE + INERTIAL.replace('diaginertia="1 1 1"', "")), "body b lacks mass or inertia"),
    "no world": ("<mujoco/>", "no <worldbody>"),
    "no joint": (body(INERTIAL), "no moving joint"),
    "massless": (body(HINGE), "nothing behind joint h has mass"),
    "mass is nan": (body(HINGE + INERTIAL.replace('mass="1"', 'mass="nan"')), "inertial mass='nan' is not finite"),
    "mass is text": (
        body(HINGE + INERTIAL.replace('mass="1"', 'mass="heavy"')),
        "inertial mass='heavy' is not",
    ),
    "gravity is text": (body(HINGE + INERTIAL, '<option gravity="down"/>'), "gravity='down'"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_content_is_named(case, tmp_path):
    text, expected = BAD[case]
    path = tmp_path / "arm.xml"
    path.write_text(text)
    with pytest.raises(RobotError) as caught:
        load_description(path)
    assert str(caught.value).startswith(str(path))
    assert re.search(expected, str(caught.value))
    assert "\n" not in str(caught.value)


ORACLE = json.loads((Path(__file__).parent / "mujoco" / "torques.json").read_text())


@pytest.mark.parametrize("case", ORACLE["cases"], ids=lambda case: f"{case['sequence']} {case['turn']}")
def test_torques_are_those_of_mujoco(case, tmp_path):
    # MuJoCo itself, not a dependency: mujoco/make_torques.py made the file
    path = tmp_path / "arm.xml"
    path.write_text((Path(__file__).parent / "mujoco" / "arm.xml").read_text().format(**case))
    robot = load_description(path)
    q, v, a = (np.array(ORACLE[key]) for key in ("q", "v", "a"))
    expected = np.array(case["tau"])
    assert np.abs(robot.inverse_dynamics(q, v, a) - expected).max() < SAME * np.abs(expected).max()
    assert robot.position_lower == pytest.approx([-np.deg2rad(170), -np.deg2rad(170), 0.0])
    assert robot.armature == pytest.approx([0.1, 0.1, 0.1])
    assert robot.joint_types == ("revolute", "revolute", "prismatic")


def test_the_zero_of_a_joint_is_its_reference(tmp_path):
    text = body(HINGE.replace("/>", ' axis="0 1 0" ref="30"/>') + INERTIAL.replace('pos="0 0 0"', 'pos="1 0 0"'))
    (tmp_path / "arm.xml").write_text(text)
    robot = load_description(tmp_path / "arm.xml")
    level = robot.gravity_torque(np.array([[np.deg2rad(30)], [np.deg2rad(120)]]))[:, 0]
    assert level == pytest.approx([-9.81, 0.0], abs=1e-9), "level as drawn at 30 degrees, hanging a quarter turn on"
