"""Writes an arm back as the URDF it came from with its inertials replaced, or as a plain URDF or MJCF.

The body behind a joint is one body in the model. In a URDF it may be several links on fixed joints: the moving link
then carries the merged inertial and the links fixed to it carry an explicit zero, because some simulators give a link
without an inertial a mass of one kilogram.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from lagnet.errors import RobotError
from lagnet.files import write_whole
from lagnet.rigid_body.descriptions.description import Description
from lagnet.rigid_body.descriptions.urdf import hold_joints
from lagnet.rigid_body.untyped_pinocchio import Inertia, Model, pin

BASE = "base"


def urdf_text(description: Description) -> str:
    """The arm as URDF text; joints that are held still are written as fixed ones.

    Gravity has no place in a URDF: an arm that is mounted otherwise is written as if it stood upright.

    Raises:
        RobotError: the arm has rotor inertias, which a URDF cannot hold.
    """
    if description.kind == "mjcf":
        return bare_urdf_text(description)
    return _serialise(_edited_urdf(description))


def bare_urdf_text(description: Description) -> str:
    """URDF text of the moving bodies alone, made from the model: no shapes, no fixed joints.

    Raises:
        RobotError: the arm has rotor inertias, which a URDF cannot hold.
    """
    if description.model.armature.any():
        raise RobotError(
            "a URDF cannot hold rotor inertias (armature)", where=description.source, next_step="write MJCF instead"
        )
    return _serialise(_bare_urdf(description))


def mjcf_text(description: Description) -> str:
    """The arm as MJCF text: bodies, joints with their limits, inertials, gravity; no shapes."""
    model = description.model
    root = Element("mujoco", model="arm")
    SubElement(root, "compiler", angle="radian")
    SubElement(root, "option", gravity=_text(model.gravity.linear))
    bodies = {0: SubElement(root, "worldbody")}
    for i in range(1, model.njoints):
        bodies[i] = _mjcf_body(bodies[model.parents[i]], description, i)
    return _serialise(root)


def _serialise(root: Element) -> str:
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode") + "\n"


def write_text(path: Path, text: str) -> None:
    """Writes the file whole or not at all."""
    write_whole(path, text)


def _edited_urdf(description: Description) -> Element:
    parser = ElementTree.XMLParser(target=ElementTree.TreeBuilder(insert_comments=True))
    root = ElementTree.fromstring(description.file.text, parser=parser)
    hold_joints(root, dict(description.held), description.file.source)
    links = {link.get("name", ""): link for link in root.findall("link")}
    moving, fixed = _children(root)
    for i in range(1, description.model.njoints):
        link = moving[description.model.names[i]]
        _set_inertial(links[link], description.model.inertias[i])
        for welded in _welded(link, fixed):
            _set_inertial(links[welded], pin.Inertia.Zero())
    return root


def _children(root: Element) -> tuple[dict[str, str], dict[str, list[str]]]:
    """Child link of each joint, and the links fixed to each link."""
    moving, fixed = {}, {}
    for joint in root.findall("joint"):
        parent, child = (joint.find(end).get("link", "") for end in ("parent", "child"))  # pyright: ignore[reportOptionalMemberAccess]
        if joint.get("type") == "fixed":
            fixed.setdefault(parent, []).append(child)
        else:
            moving[joint.get("name", "")] = child
    return moving, fixed


def _welded(link: str, fixed: Mapping[str, list[str]]) -> list[str]:
    """Every link that moves with the given one."""
    found = list(fixed.get(link, []))
    for other in found:  # grows while it is walked
        found.extend(fixed.get(other, []))
    return found


def _set_inertial(link: Element, body: Inertia) -> None:
    inertial = link.find("inertial")
    if inertial is None:
        inertial = SubElement(link, "inertial")
    for part in list(inertial):
        inertial.remove(part)
    SubElement(inertial, "origin", xyz=_text(body.lever), rpy="0 0 0")
    SubElement(inertial, "mass", value=repr(float(body.mass)))
    tensor = np.array(body.inertia)
    names = (("ixx", 0, 0), ("ixy", 0, 1), ("ixz", 0, 2), ("iyy", 1, 1), ("iyz", 1, 2), ("izz", 2, 2))
    SubElement(inertial, "inertia", {key: repr(float(tensor[i, j])) for key, i, j in names})


def _bare_urdf(description: Description) -> Element:
    """Links and joints made from the model itself."""
    model = description.model
    root = Element("robot", name="arm")
    SubElement(root, "link", name=BASE)
    for i in range(1, model.njoints):
        name, parent = description.links[i - 1], model.parents[i]
        _set_inertial(SubElement(root, "link", name=name), model.inertias[i])
        kind = description.joint_types[i - 1]
        joint = SubElement(root, "joint", name=model.names[i], type=kind)
        place = model.jointPlacements[i]
        SubElement(joint, "origin", xyz=_text(place.translation), rpy=_text(pin.rpy.matrixToRpy(place.rotation)))
        SubElement(joint, "parent", link=description.links[parent - 1] if parent else BASE)
        SubElement(joint, "child", link=name)
        SubElement(joint, "axis", xyz=_text(axis(model, i)))
        SubElement(joint, "limit", _urdf_limit(model, model.joints[i].idx_v))
    return root


def _urdf_limit(model: Model, k: int) -> dict[str, str]:
    """Limits of a joint; what is unlimited is written as a number no arm reaches, since URDF knows no infinity."""
    values = {
        "lower": model.lowerPositionLimit[k],
        "upper": model.upperPositionLimit[k],
        "effort": model.upperEffortLimit[k],
        "velocity": model.upperVelocityLimit[k],
    }
    return {key: repr(float(np.clip(value, -1e300, 1e300))) for key, value in values.items()}


def _mjcf_body(parent: Element, description: Description, i: int) -> Element:
    model = description.model
    place, k = model.jointPlacements[i], model.joints[i].idx_v
    quaternion = pin.Quaternion(place.rotation).normalized()
    turn = _text(np.array([quaternion.w, quaternion.x, quaternion.y, quaternion.z]))
    body = SubElement(parent, "body", name=description.links[i - 1], pos=_text(place.translation), quat=turn)
    prismatic = description.joint_types[i - 1] == "prismatic"
    joint = SubElement(
        body, "joint", name=model.names[i], type="slide" if prismatic else "hinge", axis=_text(axis(model, i))
    )
    lower, upper = model.lowerPositionLimit[k], model.upperPositionLimit[k]
    bounded = max(abs(lower), abs(upper)) < 1e100
    joint.set("limited", "true" if bounded else "false")
    if bounded:
        joint.set("range", _text(np.array([lower, upper])))
    if model.upperEffortLimit[k] < 1e100:
        joint.set("actuatorfrcrange", _text(np.array([-1.0, 1.0]) * model.upperEffortLimit[k]))
    if model.armature[k]:
        joint.set("armature", repr(float(model.armature[k])))
    inertia = np.array(model.inertias[i].inertia)
    tensor = inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    lever, mass = _text(model.inertias[i].lever), repr(float(model.inertias[i].mass))
    SubElement(body, "inertial", pos=lever, mass=mass, fullinertia=_text(tensor))
    return body


def axis(model: Model, i: int) -> np.ndarray:
    """Axis of joint i in its own frame."""
    kind = model.joints[i].shortname()
    if "Unaligned" in kind:
        return np.array(model.joints[i].extract().axis, dtype=float)
    return np.eye(3)["XYZ".index(kind[-1])]


def _text(values: np.ndarray) -> str:
    return " ".join(repr(float(value)) for value in values)
