"""Joints that no recording tells of are held where the user says, in URDF and MJCF alike."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.errors import ModelError, RobotError
from lagnet.models.files.loading import load_any
from lagnet.rigid_body.descriptions.named_robots import named_robot_path
from lagnet.rigid_body.robot import Robot, load_description

GRIPPER = """<mujoco><compiler angle="degree"/><worldbody>
<body name="arm"{gravcomp}><joint name="swing" axis="0 1 0"{spring}/>
<inertial pos=".2 0 .1" mass="2" diaginertia=".02 .02 .01"/>
<body name="wrist" pos=".4 0 0" euler="0 20 0"><joint name="turn" axis="1 0 1" pos="0 .1 0" ref="15"/>
<inertial pos="0 .1 .1" mass="1" diaginertia=".02 .03 .02"/>
<body name="finger" pos="0 0 .1"><joint name="slide" type="slide" axis="0 1 0"/>
<inertial pos="0 .1 0" mass="0.3" diaginertia=".01 .01 .01"/></body></body></body></worldbody></mujoco>"""
SAME = 1e-12  # relative to torques of about 10 N m
AT = {"turn": 0.7, "slide": -0.03}


def made(tmp_path, gravcomp: str = "", spring: str = "", name: str = "arm.xml"):
    (tmp_path / name).write_text(GRIPPER.format(gravcomp=gravcomp, spring=spring))
    return tmp_path / name


def urdf_of(tmp_path):
    whole = load_description(made(tmp_path))
    whole.write_urdf(tmp_path / "arm.urdf")
    return tmp_path / "arm.urdf"


def moved(whole: Robot, held: dict[str, float], rng: np.random.Generator) -> tuple[list[int], np.ndarray, np.ndarray]:
    """Which joints move, and motion of all of them in which the others stand still."""
    moving = [i for i, joint in enumerate(whole.joints) if joint not in held]
    motion = np.zeros((3, 20, whole.n_dof))
    motion[0] = [held.get(joint, 0.0) for joint in whole.joints]
    motion[:, :, moving] = rng.normal(size=(3, 20, len(moving)))
    return moving, motion, motion[:, :, moving]


@pytest.mark.parametrize("file", [made, urdf_of])
@pytest.mark.parametrize("held", [AT, {"slide": 0.05}, {"turn": -0.4}, {"swing": 0.3}], ids=str)
def test_the_torques_are_those_of_the_whole_arm_with_the_joint_at_rest(file, held, tmp_path):
    path = file(tmp_path)
    whole, arm = load_description(path), load_description(path, held)
    moving, motion, own = moved(whole, held, np.random.default_rng(1))
    assert arm.joints == tuple(whole.joints[i] for i in moving)
    expected = whole.inverse_dynamics(*motion)[:, moving]
    assert np.abs(arm.inverse_dynamics(*own) - expected).max() < SAME * np.abs(expected).max()
    assert {f"joint {name} is held at {at:g}" for name, at in held.items()} <= set(arm.warnings)


def test_fingers_of_a_file_are_held_as_those_of_the_named_robot():
    fingers = dict.fromkeys(("panda_finger_joint1", "panda_finger_joint2"), 0.0)
    arm, named = load_any(named_robot_path("panda"), fingers), load_description("panda")
    assert arm.joints == named.joints
    assert np.array_equal(arm.inertial_parameters(), named.inertial_parameters())


def test_an_arm_with_held_joints_is_written_and_read_without_them(tmp_path):
    arm = load_description(urdf_of(tmp_path), AT)
    arm.write_urdf(tmp_path / "again.urdf")
    again = load_description(tmp_path / "again.urdf")
    assert again.joints == arm.joints
    np.testing.assert_allclose(again.inertial_parameters(), arm.inertial_parameters(), atol=1e-12)


@pytest.mark.parametrize("file", [made, urdf_of])
@pytest.mark.parametrize(
    ("held", "said"),
    [
        ({"trun": 0.0}, "has no joint trun to hold"),
        ({"turn": np.nan}, "joint turn cannot be held at nan"),
        ({"swing": 0.0, "turn": 0.0, "slide": 0.0}, "has no moving joint"),
    ],
)
def test_what_cannot_be_held_is_said(file, held, said, tmp_path):
    path = file(tmp_path)
    with pytest.raises(RobotError, match=said):
        load_description(path, held)


def test_a_folder_has_no_joints_to_spare(tmp_path):
    with pytest.raises(ModelError, match="none can be held"):
        load_any(tmp_path, {"turn": 0.0})


def test_springs_and_gravity_compensation_of_a_file_are_told_to_be_left_out(tmp_path):
    plain = load_description(made(tmp_path)).warnings
    told = load_description(made(tmp_path, ' gravcomp="1"', ' stiffness="3 0.5"', "sprung.xml")).warnings
    assert set(told) - set(plain) == {
        "the spring (stiffness) of joint swing is left out",
        "gravity compensation (gravcomp) of body arm is left out",
    }
