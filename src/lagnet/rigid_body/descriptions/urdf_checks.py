"""What must hold of a URDF before it is built: numbers are numbers, and links form one tree without loops."""

from __future__ import annotations

import math
from collections import Counter
from xml.etree.ElementTree import Element

import numpy as np

from lagnet.errors import RobotError

SUPPORTED = ("fixed", "revolute", "continuous", "prismatic")
MAX_JOINTS = 2_000  # far above any robot; keeps the parser's recursion and the regressor's size in bounds
LARGEST = 1e9  # of a length, mass or inertia in SI units, even where grams and millimetres stand in their place
SCALARS = {"mass": ("value",), "inertia": ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")}
SCALARS |= {"limit": ("lower", "upper", "effort", "velocity"), "dynamics": ("damping", "friction")}
SCALARS |= {"mimic": ("multiplier", "offset")}


def numbers(
    element: Element, key: str, count: int, where: str, owner: Element, default: str | None = None
) -> np.ndarray:
    """An attribute as finite numbers.

    Raises:
        RobotError: naming the owner, the attribute and its text.
    """
    text = element.get(key, default)
    what = f"{owner.tag} {owner.get('name', '')}".strip() + f": {element.tag} {key}"
    if text is None:
        raise RobotError(f"{what} is missing", where=where)
    try:
        values = np.array([float(x) for x in text.split()])
    except ValueError:
        raise RobotError(f"{what}='{text[:60]}' is not a number", where=where) from None
    if values.size != count:
        raise RobotError(f"{what}='{text[:60]}' has {values.size} numbers, expected {count}", where=where)
    if not np.isfinite(values).all():
        raise RobotError(f"{what}='{text[:60]}' is not finite", where=where)
    if element.tag != "limit" and np.abs(values).max() > LARGEST:
        raise RobotError(f"{what}='{text[:60]}' is larger than any robot's", where=where)
    return values


def check_tree(root: Element, where: str) -> None:
    """Refuses what cannot be an arm.

    Raises:
        RobotError: naming the joint or link at fault.
    """
    if root.tag != "robot":
        raise RobotError(
            f"the root element is <{root.tag[:40]}>, expected <robot> (URDF) or <mujoco> (MJCF)", where=where
        )
    for element in root.iter():
        if "xacro" in element.tag or any("${" in value for value in element.attrib.values()):
            raise RobotError("is a xacro file", where=where, next_step="run xacro on it first")
    links, joints = root.findall("link"), root.findall("joint")
    if len(joints) > MAX_JOINTS:
        raise RobotError(f"has {len(joints)} joints, more than {MAX_JOINTS}", where=where)
    _unique("link", links, where)
    _unique("joint", joints, where)
    for link in links:
        _check_link(link, where)
    for joint in joints:
        _check_joint(joint, where)
    _check_connections({link.get("name", "") for link in links}, joints, where)


def _unique(kind: str, elements: list[Element], where: str) -> None:
    names = Counter(element.get("name") for element in elements)
    for name, times in names.items():
        if not name:
            raise RobotError(f"a {kind} has no name", where=where)
        if times > 1:
            raise RobotError(f"{times} {kind}s are named {name}", where=where)


def _check_link(link: Element, where: str) -> None:
    inertials = link.findall("inertial")
    if len(inertials) > 1:
        raise RobotError(f"link {link.get('name')} has {len(inertials)} inertials", where=where)
    for inertial in inertials:
        for tag in ("mass", "inertia"):
            if inertial.find(tag) is None:
                raise RobotError(f"the inertial of link {link.get('name')} has no <{tag}>", where=where)
        _check_numbers(inertial, link, where)
        for key in ("ixx", "iyy", "izz"):
            if inertial.find("inertia").get(key) is None:  # pyright: ignore[reportOptionalMemberAccess]
                raise RobotError(f"the inertia of link {link.get('name')} has no {key}", where=where)
        if inertial.find("mass").get("value") is None:  # pyright: ignore[reportOptionalMemberAccess]
            raise RobotError(f"the mass of link {link.get('name')} has no value", where=where)


def _check_joint(joint: Element, where: str) -> None:
    name, kind = joint.get("name"), joint.get("type")
    if kind not in SUPPORTED:
        raise RobotError(
            f"joint {name} is of type '{kind}', which has no single position", where=where, choices=SUPPORTED
        )
    for end in ("parent", "child"):
        element = joint.find(end)
        if element is None or not element.get("link"):
            raise RobotError(f"joint {name} has no {end} link", where=where)
    _check_numbers(joint, joint, where)
    limit = joint.find("limit")
    if limit is not None and float(limit.get("lower", "0")) > float(limit.get("upper", "0")):
        raise RobotError(f"joint {name} has its lower limit above its upper one", where=where)


def _check_numbers(element: Element, owner: Element, where: str) -> None:
    for part in element:
        for key in SCALARS.get(part.tag, ()):
            if part.get(key) is not None:
                if part.tag == "limit" and math.isinf(_float(part.get(key, ""))):
                    raise RobotError(
                        f"{owner.tag} {owner.get('name')}: {part.tag} {key} is infinite; leave it out", where=where
                    )
                numbers(part, key, 1, where, owner)
        if part.tag == "origin":
            for key in ("xyz", "rpy"):
                numbers(part, key, 3, where, owner, "0 0 0")
        if part.tag == "axis":
            numbers(part, "xyz", 3, where, owner, "1 0 0")


def _float(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return 0.0  # told as "not a number" by the caller


def _check_connections(links: set[str], joints: list[Element], where: str) -> None:
    parent_of: dict[str, tuple[str, str]] = {}
    for joint in joints:
        name = joint.get("name", "")
        parent, child = (joint.find(end).get("link", "") for end in ("parent", "child"))  # pyright: ignore[reportOptionalMemberAccess]
        for link in (parent, child):
            if link not in links:
                raise RobotError(f"joint {name} names link {link}, which does not exist", where=where)
        if child in parent_of:
            raise RobotError(
                f"link {child} hangs on two joints, {parent_of[child][1]} and {name}: closed loop", where=where
            )
        parent_of[child] = (parent, name)
    roots = sorted(links - set(parent_of))
    if not roots:
        raise RobotError("every link hangs on another: the joints form a closed loop", where=where)
    if len(roots) > 1:
        shown = ", ".join(roots[:5])
        raise RobotError(f"{len(roots)} links hang on nothing ({shown}); one base is expected", where=where)
    _check_reachable(links, parent_of, where)


def _check_reachable(links: set[str], parent_of: dict[str, tuple[str, str]], where: str) -> None:
    settled: set[str] = links - set(parent_of)
    for link in links:
        path: list[str] = []
        while link not in settled:
            if link in path:
                raise RobotError(f"the joints form a closed loop through link {link}", where=where)
            path.append(link)
            link = parent_of[link][0]
        settled.update(path)
