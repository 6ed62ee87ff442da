"""MJCF to a Pinocchio model: bodies, joints, inertials and their defaults; nothing that opens another file.

Read here and not by Pinocchio's own parser, which writes past its buffers on malformed files.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
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
from lagnet.rigid_body.descriptions.mass_checks import mass_warnings, require_mass
from lagnet.rigid_body.descriptions.mjcf_checks import SUPPORTED, reduce_mjcf
from lagnet.rigid_body.descriptions.mjcf_frames import Reading, placement, shape_inertia, stated_inertia
from lagnet.rigid_body.descriptions.urdf_checks import numbers
from lagnet.rigid_body.descriptions.xml_files import XmlFile
from lagnet.rigid_body.untyped_pinocchio import SE3, Inertia, JointModel, Model, pin

MOST_COEFFICIENTS = 3
Defaults = dict[str, dict[str, dict[str, str]]]  # class → tag → attributes


def read_mjcf(file: XmlFile, held: Mapping[str, float] = NONE_HELD) -> Description:
    """The arm of an MJCF file whose bodies state their inertials, or have plain shapes to take them from.

    Args:
        file: the file's bytes.
        held: joints to hold still and where [rad or m], e.g. fingers.

    Raises:
        RobotError: naming the file and the body or joint at fault.
    """
    root, where = file.root(), file.source
    warnings = reduce_mjcf(root, where)
    names = [joint.get("name", "") for joint in root.iter("joint") if joint.get("name")]
    warnings += check_held(held, names, where)
    reader = _reader(root, where, held)
    for body in root.findall("worldbody/body"):
        reader.add_body(body, 0, pin.SE3.Identity(), "main")
    for option in root.findall("option"):
        if option.get("gravity") is not None:
            reader.model.gravity.linear = numbers(option, "gravity", 3, where, option)
    model = reader.model
    if model.nv == 0:
        raise RobotError("has no moving joint", where=where)
    warnings += friction_warning(reader.declared["friction"]) + left_out_warnings(reader.declared)
    require_mass(model, where)  # a simulator that reads the file refuses it as well
    warnings += mass_warnings(model, where)
    links = moving_bodies(model)
    inertials = tuple((link, model.inertias[i + 1].toDynamicParameters()) for i, link in enumerate(links))
    still = tuple(held.items())
    return Description(model, tuple(reader.types), links, inertials, "mjcf", where, file, still, tuple(warnings))


def _reader(root: Element, where: str, held: Mapping[str, float]) -> _Reader:
    settings: dict[str, str] = {}
    for compiler in root.findall("compiler"):
        settings.update(compiler.attrib)
    defaults: Defaults = {"main": {}}
    for group in root.findall("default"):
        _collect(group, "main", defaults, where)
    reading = Reading(where, settings.get("angle", "degree") == "degree", settings.get("eulerseq", "xyz"))
    from_shapes, auto = settings.get("inertiafromgeom") == "true", settings.get("autolimits", "true") == "true"
    return _Reader(reading, defaults, from_shapes, auto, held)


def _collect(group: Element, parent: str, defaults: Defaults, where: str, top: bool = True) -> None:
    """Default attributes of each class; a class inside another starts from that one's."""
    name = group.get("class", "main" if top else "")
    if not name or (name in defaults and name != "main"):
        raise RobotError(f"default class '{name[:60]}' is nameless or given twice", where=where)
    own = {tag: dict(attributes) for tag, attributes in defaults[parent].items()}
    for part in group:
        if part.tag in ("joint", "geom"):
            own.setdefault(part.tag, {}).update(part.attrib)
    defaults[name] = own
    for part in group.findall("default"):
        _collect(part, name, defaults, where, top=False)


@dataclass
class _Reader:
    """Adds bodies to a model one by one, from the base outwards."""

    reading: Reading
    defaults: Defaults
    from_shapes: bool
    auto_limits: bool
    held: Mapping[str, float]
    model: Model = field(default_factory=pin.Model)
    types: list[str] = field(default_factory=list)
    declared: dict[str, list[str]] = field(default_factory=lambda: {"friction": [], "spring": [], "gravcomp": []})

    def add_body(self, body: Element, parent: int, offset: SE3, inherited: str) -> None:
        """Adds a body and all that hangs on it; offset is the frame around it in the frame of the joint before."""
        inherited = body.get("childclass", inherited)
        place = offset * placement(body, body, self.reading)
        if numbers(body, "gravcomp", 1, self.reading.where, body, "0")[0]:
            self.declared["gravcomp"].append(body.get("name", ""))
        joint = body.find("joint")
        if joint is not None and joint.get("name", "") in self.held:
            place = place * self._held_at(self._resolved(joint, inherited, body), body)
        elif joint is not None:
            parent, place = self._add_joint(self._resolved(joint, inherited, body), body, parent, place)
        self.model.appendBodyToJoint(parent, self._inertia(body, inherited), place)
        self._add_frame(body, parent, place)
        for child in body.findall("body"):
            self.add_body(child, parent, place, inherited)

    def _add_frame(self, body: Element, joint: int, place: SE3) -> None:
        before = self.model.getFrameId(self.model.names[joint], pin.FrameType.JOINT) if joint else 0
        name = body.get("name", "")
        self.model.addFrame(pin.Frame(name, joint, before, place, pin.FrameType.BODY, pin.Inertia.Zero()))

    def _resolved(self, element: Element, inherited: str, body: Element) -> Element:
        """The element with the defaults of its class filled in."""
        name = element.get("class", inherited)
        if name not in self.defaults:
            what = f"body {body.get('name')} names the unknown class '{name[:60]}'"
            raise RobotError(what, where=self.reading.where, choices=sorted(self.defaults))
        return Element(element.tag, self.defaults[name].get(element.tag, {}) | element.attrib)

    def _inertia(self, body: Element, inherited: str) -> Inertia:
        inertial = body.find("inertial")
        if inertial is not None and not self.from_shapes:
            return stated_inertia(inertial, body, self.reading)
        total = pin.Inertia.Zero()
        for shape in body.findall("geom"):
            part = shape_inertia(self._resolved(shape, inherited, body), body, self.reading)
            total = part if total.mass == 0 else total + part
        return total

    def _add_joint(self, joint: Element, body: Element, parent: int, place: SE3) -> tuple[int, SE3]:
        """Adds the joint of a body and returns its index and where the body lies in its frame."""
        name, (kind, axis, anchor, reference) = joint.get("name", ""), self._geometry(joint, body)
        start = place * anchor * _displacement(kind, axis, -reference)
        low, high = self._limits(joint, kind, body)
        scalars = [np.array([x]) for x in (self._effort(joint, body), np.inf, low, high)]
        index = self.model.addJoint(parent, _joint_model(kind, axis), start, name, *scalars)
        self.model.addJointFrame(index)
        bounded = np.isfinite(low) and np.isfinite(high)
        self.types.append("prismatic" if kind == "slide" else "revolute" if bounded else "continuous")
        self._declared(joint, body, index)
        return index, anchor.inverse()

    def _held_at(self, joint: Element, body: Element) -> SE3:
        """How far a joint that is held still moves its body from where it is drawn."""
        kind, axis, anchor, reference = self._geometry(joint, body)
        return anchor * _displacement(kind, axis, self.held[joint.get("name", "")] - reference) * anchor.inverse()

    def _geometry(self, joint: Element, body: Element) -> tuple[str, np.ndarray, SE3, np.ndarray]:
        """Kind, unit axis and point of a joint in its body, and the position [rad or m] at which the body is drawn."""
        name, kind, where = joint.get("name", ""), joint.get("type", "hinge"), self.reading.where
        if kind not in SUPPORTED:
            what = f"joint {name} of body {body.get('name')} is of type '{kind[:60]}', which has no single position"
            raise RobotError(what, where=where, choices=SUPPORTED)
        axis = numbers(joint, "axis", 3, where, body, "0 0 1")
        if np.linalg.norm(axis) < 1e-9:
            raise RobotError(f"joint {name} has an axis of length zero", where=where)
        anchor = pin.SE3(np.eye(3), numbers(joint, "pos", 3, where, body, "0 0 0"))
        (reference,) = numbers(joint, "ref", 1, where, body, "0")
        return kind, axis / np.linalg.norm(axis), anchor, self._turned(kind, reference)

    def _turned(self, kind: str, value: np.ndarray | float) -> np.ndarray:
        return self.reading.angle(value) if kind == "hinge" else np.asarray(value, dtype=float)

    def _limits(self, joint: Element, kind: str, body: Element) -> tuple[float, float]:
        limited = joint.get("limited", "auto")
        if limited not in ("true", "false", "auto"):
            what = f"joint {joint.get('name')} limited='{limited[:60]}' is unknown"
            raise RobotError(what, where=self.reading.where, choices=("true", "false", "auto"))
        if limited == "false" or joint.get("range") is None or (limited == "auto" and not self.auto_limits):
            return -np.inf, np.inf
        low, high = self._turned(kind, numbers(joint, "range", 2, self.reading.where, body))
        if low > high:
            what = f"joint {joint.get('name')} has its lower limit above its upper one"
            raise RobotError(what, where=self.reading.where)
        return float(low), float(high)

    def _effort(self, joint: Element, body: Element) -> float:
        if joint.get("actuatorfrcrange") is None:
            return np.inf
        return float(np.abs(numbers(joint, "actuatorfrcrange", 2, self.reading.where, body)).max())

    def _coefficients(self, joint: Element, key: str, body: Element) -> np.ndarray:
        """One number, or the coefficients of a polynomial that newer MuJoCo takes for damping and stiffness."""
        count = min(max(1, len(joint.get(key, "0").split())), MOST_COEFFICIENTS)
        return numbers(joint, key, count, self.reading.where, body, "0")

    def _declared(self, joint: Element, body: Element, index: int) -> None:
        """Rotor inertia is part of the model; damping, friction and springs are only noted."""
        for what, keys in (("friction", ("damping", "frictionloss")), ("spring", ("stiffness",))):
            if any(self._coefficients(joint, key, body).any() for key in keys):
                self.declared[what].append(joint.get("name", ""))
        armature = np.array(self.model.armature)
        armature[self.model.joints[index].idx_v] = numbers(joint, "armature", 1, self.reading.where, body, "0")[0]
        self.model.armature = armature


def left_out_warnings(declared: Mapping[str, list[str]]) -> list[str]:
    """What is said of torques that a simulator would add: they must stay visible in a comparison."""
    words = {"spring": "the spring (stiffness) of joint", "gravcomp": "gravity compensation (gravcomp) of body"}
    return [f"{words[key]} {', '.join(declared[key])} is left out" for key in words if declared[key]]


def _joint_model(kind: str, axis: np.ndarray) -> JointModel:
    """A joint along x, y or z where it can be, which is computed faster than one along any axis."""
    along = np.flatnonzero(axis == 1.0)
    if kind == "hinge":
        plain = (pin.JointModelRX, pin.JointModelRY, pin.JointModelRZ)
        return plain[along[0]]() if along.size else pin.JointModelRevoluteUnaligned(axis)
    plain = (pin.JointModelPX, pin.JointModelPY, pin.JointModelPZ)
    return plain[along[0]]() if along.size else pin.JointModelPrismaticUnaligned(axis)


def _displacement(kind: str, axis: np.ndarray, position: np.ndarray) -> SE3:
    if kind == "slide":
        return pin.SE3(np.eye(3), axis * position)
    return pin.SE3(pin.exp3(axis * position), np.zeros(3))
