"""URDF of a corrected arm: bodies, encoder shifts and motors in the tree; what a URDF has an element for."""

from __future__ import annotations

import tempfile
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from scipy.spatial.transform import Rotation

from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics
from lagnet.simulators.corrected_arm.forward_motion import motor_inertia
from lagnet.simulators.xml_text import number, numbers, roll_pitch_yaw

MOTOR, LINK = "_motor", "_link"  # endings of names between motor and link
NO_LIMIT = "1e9"
UNIT = np.eye(3)
TINY = 1e-9  # [kg]
BODY_SHARE = 0.01  # of a motor's rotor that a body holds; the rest must not turn with the joints before it


def urdf_of(arm: ArmPhysics, bare: bool) -> Element:
    """The arm as URDF with encoder shifts.

    Args:
        arm: its physics.
        bare: without shapes and meshes, and with a body for the motor where a transmission gives.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "arm.urdf"
        (arm.robot.write_bare_urdf if bare else arm.robot.write_urdf)(path)
        root = ElementTree.parse(path).getroot()
    if bare:
        _inertial(root.findall("link")[0], 0.0, 0.0, UNIT[2])  # else PyBullet makes up a kilogram for the base
    joints = {joint.get("name"): joint for joint in root.findall("joint")}
    for j, body in enumerate(arm.robot.body_tree()):
        joint = joints[body.joint]
        if arm.shift[j]:
            _shifted(joint, body.turns, float(arm.shift[j]))
        if bare and arm.compliant[j]:
            _split(root, joint, BODY_SHARE * float(motor_inertia(arm)[j]))
    return root


def tilted_root(root: Element, gravity: np.ndarray) -> None:
    """A link above the base, so that gravity points along −z of the world: a URDF itself has no place for it."""
    down = gravity / np.linalg.norm(gravity)
    if np.allclose(down, (0.0, 0.0, -1.0), atol=1e-12):
        return
    children = {j.find("child").get("link") for j in root.findall("joint")}  # pyright: ignore[reportOptionalMemberAccess]
    base = next(link.get("name", "") for link in root.findall("link") if link.get("name") not in children)
    turn = Rotation.align_vectors([[0.0, 0.0, -1.0]], [down])[0].as_matrix()
    SubElement(root, "link", name="level_world")
    joint = SubElement(root, "joint", name="mounting", type="fixed")
    SubElement(joint, "origin", xyz="0 0 0", rpy=numbers(roll_pitch_yaw(turn)))
    SubElement(joint, "parent", link="level_world")
    SubElement(joint, "child", link=base)


def _vector(joint: Element, tag: str, key: str, default: np.ndarray) -> np.ndarray:
    element = joint.find(tag)
    text = None if element is None else element.get(key)
    return default if text is None else np.array([float(x) for x in text.split()])


def _shifted(joint: Element, turns: bool, shift: float) -> None:
    """The joint's frame turned, or moved, by what the encoder is off."""
    position = _vector(joint, "origin", "xyz", np.zeros(3))
    rotation = Rotation.from_euler("xyz", _vector(joint, "origin", "rpy", np.zeros(3)))
    axis = _vector(joint, "axis", "xyz", UNIT[0])
    axis = axis / np.linalg.norm(axis)
    if turns:
        rotation = rotation * Rotation.from_rotvec(shift * axis)
    else:
        position = position + rotation.apply(shift * axis)
    origin = joint.find("origin")
    if origin is None:
        origin = SubElement(joint, "origin")
    origin.attrib.update(xyz=numbers(position), rpy=numbers(rotation.as_euler("xyz")))


def _split(root: Element, joint: Element, rotor: float) -> None:
    """The motor's body between a joint and its link, with a share of its rotor as inertia about the axis."""
    name, child = joint.get("name", ""), joint.find("child")
    assert child is not None
    axis = _vector(joint, "axis", "xyz", UNIT[0])
    axis = axis / np.linalg.norm(axis)
    motor = SubElement(root, "link", name=name + MOTOR)
    prismatic = joint.get("type") == "prismatic"
    _inertial(motor, rotor if prismatic else TINY, 0.0 if prismatic else rotor, axis)
    link = SubElement(
        root, "joint", name=name + LINK, type=str(joint.get("type", "revolute")).replace("continuous", "revolute")
    )
    SubElement(link, "parent", link=name + MOTOR)
    SubElement(link, "child", link=child.get("link", ""))
    SubElement(link, "axis", xyz=numbers(axis))
    SubElement(link, "limit", lower="-3.0", upper="3.0", effort=NO_LIMIT, velocity=NO_LIMIT)
    child.set("link", name + MOTOR)


def _inertial(link: Element, mass: float, about_axis: float, axis: np.ndarray) -> None:
    inertial = SubElement(link, "inertial")
    SubElement(inertial, "origin", xyz="0 0 0", rpy="0 0 0")
    SubElement(inertial, "mass", value=number(mass))
    across = max(0.501 * about_axis, 1e-12)  # no body has less across an axis than half of what it has about it
    tensor = about_axis * np.outer(axis, axis) + across * (UNIT - np.outer(axis, axis))
    names = (("ixx", 0, 0), ("ixy", 0, 1), ("ixz", 0, 2), ("iyy", 1, 1), ("iyz", 1, 2), ("izz", 2, 2))
    SubElement(inertial, "inertia", {key: number(tensor[i, k]) for key, i, k in names})
