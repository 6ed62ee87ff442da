"""URDF to a Pinocchio model: kinematics and inertias alone, meshes never opened, every defect named."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np

from lagnet.errors import RobotError
from lagnet.rigid_body.descriptions.description import (
    NONE_HELD,
    Description,
    check_held,
    friction_warning,
    moving_bodies,
)
from lagnet.rigid_body.descriptions.mass_checks import mass_warnings
from lagnet.rigid_body.descriptions.urdf_checks import check_tree, numbers
from lagnet.rigid_body.descriptions.xml_files import XmlFile
from lagnet.rigid_body.inertia import parameters_of_body
from lagnet.rigid_body.untyped_pinocchio import SE3, Model, pin

MOVING = ("revolute", "continuous", "prismatic")
UNLIMITED = "1e300"  # a limit that the URDF parser accepts; callers see inf
KEPT = {"link": ("inertial",), "joint": ("origin", "parent", "child", "axis", "limit")}


def read_urdf(
    file: XmlFile, kind: str = "urdf", source: str | None = None, held: Mapping[str, float] = NONE_HELD
) -> Description:
    """The arm of a URDF file.

    Args:
        file: the file's bytes.
        kind: 'urdf' or 'named_robot'.
        source: what the user asked for, the file's path by default.
        held: joints to hold still and where [rad or m], e.g. fingers.

    Raises:
        RobotError: naming the file and the joint or link at fault.
    """
    root = file.root()
    warnings: list[str] = []
    types, positions = normalise(root, file.source, held, warnings)
    model = _build(root, file.source)
    joint_types = tuple(types[name] for name in model.names[1:])
    warnings += mass_warnings(model, file.source)
    links = moving_bodies(model)
    inertials = tuple(_link_inertials(root))
    return Description(
        model,
        joint_types,
        links,
        inertials,
        kind,
        source or file.source,
        file,
        tuple(positions.items()),
        tuple(warnings),
    )


def normalise(
    root: Element, where: str, held: Mapping[str, float], warnings: list[str]
) -> tuple[dict[str, str], dict[str, float]]:
    """Strips the tree to kinematics and inertias and holds still what does not belong to the arm.

    Continuous joints become revolute ones without limits, so that one angle stands for their position instead of a
    point on the unit circle: the physics is the same.

    Returns:
        Type of each moving joint, and the position of each joint held still.
    """
    check_tree(root, where)
    _strip(root)
    joints = {joint.get("name", ""): joint for joint in root.findall("joint")}
    moving = [name for name, joint in joints.items() if joint.get("type") in MOVING]
    warnings += check_held(held, moving, where)
    positions = _held_positions(joints, held, warnings)
    hold_joints(root, positions, where)
    types = {}
    for name, joint in joints.items():
        kind = joint.get("type", "")
        if kind in MOVING:
            types[name] = kind
            _prepare(joint, where, warnings)
    warnings += _leave_out_friction(joints)
    if not types:
        raise RobotError("has no moving joint", where=where)
    return types, positions


def _strip(root: Element) -> None:
    """Removes shapes, materials, transmissions and simulator extensions: nothing here that opens another file."""
    name = root.get("name") or "robot"
    root.attrib.clear()
    root.set("name", name)
    for child in list(root):
        if child.tag not in KEPT:
            root.remove(child)
            continue
        for part in list(child):
            if part.tag not in (*KEPT[child.tag], "mimic", "dynamics"):
                child.remove(part)
    for tensor in root.iter("inertia"):
        for key in ("ixy", "ixz", "iyz"):
            tensor.set(key, tensor.get(key, "0"))


def _held_positions(joints: dict[str, Element], held: Mapping[str, float], warnings: list[str]) -> dict[str, float]:
    positions = dict(held)
    for name, joint in joints.items():
        mimic = joint.find("mimic")
        if mimic is not None and name not in positions and joint.get("type") in MOVING:
            positions[name] = float(mimic.get("offset", "0"))
            warnings.append(
                f"joint {name} mimics {mimic.get('joint')}: held at {positions[name]:g} on the link before it"
            )
    return positions


def hold_joints(root: Element, positions: Mapping[str, float], where: str) -> None:
    """Turns joints of a URDF into fixed ones at the given positions."""
    for joint in root.findall("joint"):
        mimic, name = joint.find("mimic"), joint.get("name", "")
        if mimic is not None:
            joint.remove(mimic)
        if name in positions:
            _hold(joint, positions[name], where)


def _hold(joint: Element, position: float, where: str) -> None:
    """Turns a moving joint into a fixed one at the given position."""
    if position:
        placement = origin_of(joint, where) * _motion(joint, position, where)
        origin = joint.find("origin")
        origin = ElementTree.SubElement(joint, "origin") if origin is None else origin
        write_placement(origin, placement)
    joint.set("type", "fixed")


def _motion(joint: Element, position: float, where: str) -> SE3:
    axis = axis_of(joint, where)
    if joint.get("type") == "prismatic":
        return pin.SE3(np.eye(3), position * axis)
    return pin.SE3(pin.exp3(position * axis), np.zeros(3))


def axis_of(joint: Element, where: str) -> np.ndarray:
    """Unit axis of a joint in the joint's frame."""
    element = joint.find("axis")
    axis = np.array([1.0, 0.0, 0.0]) if element is None else numbers(element, "xyz", 3, where, joint)
    length = float(np.linalg.norm(axis))
    if length < 1e-9:
        raise RobotError(f"joint {joint.get('name')} has an axis of length zero", where=where)
    return axis / length


def origin_of(element: Element, where: str) -> SE3:
    """Placement given by the `origin` of a joint or an inertial."""
    origin = element.find("origin")
    if origin is None:
        return pin.SE3.Identity()
    xyz, rpy = (numbers(origin, key, 3, where, element, "0 0 0") for key in ("xyz", "rpy"))
    return pin.SE3(pin.rpy.rpyToMatrix(rpy), xyz)


def write_placement(origin: Element, placement: SE3) -> None:
    """Writes a placement into an `origin`, with digits that lose nothing."""
    origin.set("xyz", " ".join(repr(float(x)) for x in placement.translation))
    origin.set("rpy", " ".join(repr(float(x)) for x in pin.rpy.matrixToRpy(placement.rotation)))


def _prepare(joint: Element, where: str, warnings: list[str]) -> None:
    """Unit axis, complete limits, and what the rigid bodies leave aside said aloud."""
    axis = joint.find("axis")
    if axis is not None:
        axis.set("xyz", " ".join(repr(float(x)) for x in axis_of(joint, where)))
    limit, continuous = joint.find("limit"), joint.get("type") == "continuous"
    if limit is None:
        limit = ElementTree.SubElement(joint, "limit")
        if not continuous:
            warnings.append(f"joint {joint.get('name')} has no limit element: taken as unlimited")
        continuous = continuous or not limit.attrib
    if continuous:
        limit.set("lower", f"-{UNLIMITED}")
        limit.set("upper", UNLIMITED)
    for key in ("effort", "velocity"):
        if float(limit.get(key, "0")) <= 0:  # zero is how exporters write "unknown"
            limit.set(key, UNLIMITED)
    if joint.get("type") == "continuous":
        joint.set("type", "revolute")


def _leave_out_friction(joints: Mapping[str, Element]) -> list[str]:
    """Takes declared damping and friction off: a nominal model of rigid bodies must not explain them away."""
    found = []
    for name, joint in joints.items():
        dynamics = joint.find("dynamics")
        if dynamics is None:
            continue
        declared = any(float(dynamics.get(key, "0")) for key in ("damping", "friction"))
        if declared and joint.get("type") != "fixed":
            found.append(name)
        joint.remove(dynamics)
    return friction_warning(found)


def _build(root: Element, where: str) -> Model:
    text = ElementTree.tostring(root, encoding="unicode")
    try:
        model = pin.buildModelFromXML(text)
    except Exception as error:  # the parser raises bare exceptions of several kinds
        raise RobotError(f"is not a URDF that can be built ({str(error).strip()})", where=where) from error
    return model


def _link_inertials(root: Element) -> Iterable[tuple[str, np.ndarray]]:
    for link in root.findall("link"):
        inertial = link.find("inertial")
        if inertial is not None:
            yield link.get("name", ""), inertial_parameters(inertial, link.get("name", ""))


def inertial_parameters(inertial: Element, where: str) -> np.ndarray:
    """Ten inertial parameters of an `inertial` element about the link's origin, in the link's frame."""
    mass, tensor = inertial.find("mass"), inertial.find("inertia")
    assert mass is not None, "checked before"
    assert tensor is not None, "checked before"
    m = float(mass.get("value", "nan"))
    i = {k: float(tensor.get(k, "0")) for k in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")}
    about_com = np.array(
        [[i["ixx"], i["ixy"], i["ixz"]], [i["ixy"], i["iyy"], i["iyz"]], [i["ixz"], i["iyz"], i["izz"]]]
    )
    placement = origin_of(inertial, where)
    return parameters_of_body(m, placement.translation, placement.rotation @ about_com @ placement.rotation.T)
