"""What an MJCF says of the servos at its joints: gains, limits, damping, dry friction."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from lagnet.errors import RobotError
from lagnet.rigid_body.descriptions.urdf_checks import numbers
from lagnet.rigid_body.robot import Robot

TAGS = ("position", "general")
Defaults = dict[str, dict[str, dict[str, str]]]  # class → tag → attributes


def position_actuators(robot: Robot) -> tuple[dict[str, dict[str, float]], tuple[str, ...]]:
    """Numbers of the servo at each joint by joint name, and what was given and is left out.

    Of position actuators: `kp` [N m/rad], `kd` [N m s/rad], `torque_limit` [N m]; of every joint: `viscous`, `coulomb`
    and `rotor`. A joint without a position actuator has no `kp`.

    Raises:
        RobotError: a number in the file that is none.
    """
    if robot.kind != "mjcf":
        return {}, ()
    root, where = robot._description.file.root(), robot.source
    defaults: Defaults = {"main": {}}
    for group in root.findall("default"):
        _collect(group, "main", defaults)
    found: dict[str, dict[str, float]] = {}
    for joint, inherited in _joints(root, "main"):
        name, given = joint.get("name", ""), _resolved(joint, inherited, defaults)
        if name in robot.joints:
            keys = {"viscous": "damping", "coulomb": "frictionloss", "rotor": "armature"}
            found[name] = {ours: _number(given, theirs, where) for ours, theirs in keys.items()}
    notes = []
    for actuator in root.findall("actuator/*"):
        name = actuator.get("joint", "")
        if actuator.tag not in TAGS or name not in found:
            notes.append(f"actuator {actuator.get('name', '')[:60]} ({actuator.tag[:30]}) is no servo of a joint")
            continue
        found[name] |= _gains(_resolved(actuator, "main", defaults), where)
    return found, tuple(notes)


def _gains(actuator: Element, where: str) -> dict[str, float]:
    """kp, kd and limit of a `position` or an affine `general` actuator."""
    if actuator.tag == "position":
        kp, kd = _number(actuator, "kp", where, "1"), _number(actuator, "kv", where)
    else:
        bias = [*actuator.get("biasprm", "0 0 0").split(), "0", "0", "0"][:3]
        kp = float(
            numbers(Element("general", {"kp": actuator.get("gainprm", "1").split()[0]}), "kp", 1, where, actuator)[0]
        )
        kd = -float(numbers(Element("general", {"kv": bias[2]}), "kv", 1, where, actuator)[0])
    gear = abs(
        float(numbers(Element("a", {"gear": actuator.get("gear", "1").split()[0]}), "gear", 1, where, actuator)[0])
    )
    out = {"kp": kp * gear * gear, "kd": max(kd, 0.0) * gear * gear}
    if actuator.get("forcerange") is not None and actuator.get("forcelimited", "auto") != "false":
        low, high = numbers(actuator, "forcerange", 2, where, actuator)
        out["torque_limit"] = float(min(abs(low), abs(high))) * gear
    return out


def _number(element: Element, key: str, where: str, otherwise: str = "0") -> float:
    first = Element(element.tag, {key: element.get(key, otherwise).split()[0] if element.get(key, otherwise) else "0"})
    return float(numbers(first, key, 1, where, element, otherwise)[0])


def _collect(group: Element, parent: str, defaults: Defaults) -> None:
    """Default attributes of each class; a class inside another starts from that one's."""
    name = group.get("class", "main")
    own = {tag: dict(attributes) for tag, attributes in defaults.get(parent, {}).items()}
    for part in group:
        if part.tag != "default":
            own.setdefault(part.tag, {}).update(part.attrib)
    defaults[name] = own
    for part in group.findall("default"):
        _collect(part, name, defaults)


def _joints(element: Element, inherited: str) -> Iterator[tuple[Element, str]]:
    """Every joint with the default class of the body around it."""
    for body in element.iter("worldbody") if element.tag == "mujoco" else element.findall("body"):
        around = body.get("childclass", inherited)
        for joint in body.findall("joint"):
            yield joint, around
        yield from _joints(body, around)


def _resolved(element: Element, inherited: str, defaults: Defaults) -> Element:
    """The element with the defaults of its class filled in."""
    name = element.get("class", inherited)
    if name not in defaults:
        raise RobotError(f"unknown default class '{name[:60]}'", choices=sorted(defaults))
    return Element(element.tag, defaults[name].get(element.tag, {}) | element.attrib)
