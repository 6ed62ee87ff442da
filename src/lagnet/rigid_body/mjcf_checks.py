"""Reduces MJCF to what an arm needs, every attribute checked.

The parser behind it writes past its buffers on malformed numbers, so it must never see one.
"""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from lagnet.errors import RobotError
from lagnet.rigid_body.urdf_checks import MAX_JOINTS, numbers

SUPPORTED = ("hinge", "slide")
SHAPES = ("sphere", "capsule", "ellipsoid", "cylinder", "box")  # bodies without an inertial take it from these
KEPT = ("compiler", "default", "worldbody")
LEFT_OUT = ("equality", "tendon")  # said aloud: they would change the motion
REFUSED = ("include", "model", "attach", "plugin", "frame", "replicate", "composite", "flexcomp")
TURNED = {"pos": 3, "quat": 4, "axisangle": 4, "xyaxes": 6, "zaxis": 3, "euler": 3}
NUMBERS = {
    "body": TURNED,
    "inertial": TURNED | {"mass": 1, "diaginertia": 3, "fullinertia": 6},
    "joint": {"pos": 3, "axis": 3, "range": 2, "actuatorfrcrange": 2}
    | dict.fromkeys(("armature", "damping", "frictionloss", "ref"), 1),
    "geom": TURNED | {"fromto": 6, "density": 1, "mass": 1},
}
BOOLEANS = ("true", "false", "auto")
WORDS = {
    "compiler": {"angle": ("radian", "degree"), "autolimits": ("true", "false")},
    "joint": {"type": SUPPORTED, "limited": BOOLEANS, "actuatorfrclimited": BOOLEANS},
    "geom": {"type": SHAPES},
}
NAMES = {"body": ("name", "childclass"), "joint": ("name", "class"), "geom": ("class",), "default": ("class",)}
CHILDREN = {"body": ("body", "joint", "geom", "inertial"), "default": ("default", "joint", "geom")}


def reduce_mjcf(root: Element, where: str) -> list[str]:
    """Strips the tree to bodies, joints, inertials and their defaults, in place.

    Returns:
        Warnings on what was left out.

    Raises:
        RobotError: what would open another file, is no arm of simple joints, or is malformed.
    """
    for element in root.iter():
        if element.tag in REFUSED:
            raise RobotError(f"<{element.tag}> is refused: one file must spell out the whole arm", where=where)
    warnings = [f"<{tag}> is left out" for tag in LEFT_OUT if len(root.findall(tag))]
    _keep(root, KEPT)
    world = root.find("worldbody")
    if world is None:
        raise RobotError("has no <worldbody>", where=where)
    _keep(world, ("body",))
    for compiler in root.findall("compiler"):
        if compiler.get("inertiafromgeom") == "true":
            _drop_inertials(world)
        _reduce_compiler(compiler, where)
    classes = _reduce_defaults(root, where)
    bodies = list(world.iter("body"))
    if not any(body.find("joint") is not None or body.find("freejoint") is not None for body in bodies):
        raise RobotError("has no moving joint", where=where)
    if len(bodies) > MAX_JOINTS:
        raise RobotError(f"has {len(bodies)} bodies, more than {MAX_JOINTS}", where=where)
    for k, body in enumerate(bodies):
        _reduce_body(body, k, classes, where)
    _unique(bodies, where)
    return warnings


def _keep(element: Element, tags: tuple[str, ...]) -> None:
    for child in list(element):
        if child.tag not in tags:
            element.remove(child)


def _drop_inertials(world: Element) -> None:
    """What the file asks for: the inertia of every body comes from its shapes."""
    for body in world.iter("body"):
        for inertial in body.findall("inertial"):
            body.remove(inertial)


def _reduce_compiler(compiler: Element, where: str) -> None:
    if compiler.get("coordinate") == "global":
        raise RobotError("compiler coordinate='global' is not supported: give local frames", where=where)
    if compiler.get("settotalmass") is not None:
        raise RobotError("compiler settotalmass is not supported: state the masses", where=where)
    sequence = compiler.get("eulerseq", "xyz")
    if len(sequence) != 3 or set(sequence) - set("xyzXYZ"):
        raise RobotError(f"compiler eulerseq='{sequence[:20]}' is not three axes", where=where)
    _clean(compiler, where, keep={"eulerseq": sequence})


def _reduce_defaults(root: Element, where: str) -> set[str]:
    """Cleans the defaults and returns the names of their classes."""
    classes: set[str] = set()
    for top in root.findall("default"):
        for group in top.iter("default"):
            _keep(group, CHILDREN["default"])
            for part in group:
                if part.tag != "default":
                    _check_joint_type(part, "a default", where)
                    _clean(part, where)
            name = group.get("class", "main" if group is top else "")
            if not name or name in classes:
                raise RobotError(f"default class '{name[:60]}' is nameless or given twice", where=where)
            classes.add(name)
            group.attrib.clear()
            group.set("class", name)
    return classes


def _reduce_body(body: Element, k: int, classes: set[str], where: str) -> None:
    body.set("name", body.get("name") or f"body_{k}")
    _check_joints(body, k, where)
    inertials = body.findall("inertial")
    if len(inertials) > 1:
        raise RobotError(f"body {body.get('name')} has {len(inertials)} inertials", where=where)
    if any(i.get("mass") is None or not {"diaginertia", "fullinertia"} & set(i.attrib) for i in inertials):
        raise RobotError(f"the inertial of body {body.get('name')} lacks mass or inertia", where=where)
    for geom in body.findall("geom"):
        _check_shape(geom, body, bool(inertials), where)
    _keep(body, CHILDREN["body"])
    for part in (body, *(part for part in body if part.tag != "body")):
        for key in ("class", "childclass"):
            if part.get(key, "main") not in classes | {"main"}:
                raise RobotError(f"body {body.get('name')} names the unknown class '{part.get(key)}'", where=where)
        _clean(part, where, owner=body)


def _check_joints(body: Element, k: int, where: str) -> None:
    if body.find("freejoint") is not None:
        raise RobotError(
            f"body {body.get('name')} has a joint of type 'free', which has no single position",
            where=where,
            choices=SUPPORTED,
        )
    joints = body.findall("joint")
    if len(joints) > 1:
        raise RobotError(f"body {body.get('name')} has {len(joints)} joints; give each its own body", where=where)
    for joint in joints:
        joint.set("name", joint.get("name") or f"joint_{k}")
        _check_joint_type(joint, f"joint {joint.get('name')} of body {body.get('name')}", where)


def _check_joint_type(joint: Element, who: str, where: str) -> None:
    if joint.tag == "joint" and joint.get("type", "hinge") not in SUPPORTED:
        what = f"{who} is of type '{joint.get('type', '')[:60]}', which has no single position"
        raise RobotError(what, where=where, choices=SUPPORTED)


def _check_shape(geom: Element, body: Element, has_inertial: bool, where: str) -> None:
    """Drops shapes of a body that states its inertial; others must be plain ones."""
    if has_inertial:
        body.remove(geom)
    elif geom.get("mesh") is not None or geom.get("type", "sphere") not in SHAPES:
        what = f"body {body.get('name')} has a shape of type '{geom.get('type', 'mesh')[:60]}' and no <inertial>"
        raise RobotError(what, where=where, next_step="state its inertial")
    elif not 1 <= len(geom.get("size", "1").split()) <= 3:
        raise RobotError(f"a shape of body {body.get('name')} has a malformed size", where=where)
    elif geom.get("size"):
        numbers(geom, "size", len(geom.get("size", "").split()), where, body)


def _clean(element: Element, where: str, owner: Element | None = None, keep: dict[str, str] | None = None) -> None:
    """Leaves the attributes known here, after a look at each."""
    tag, kept = element.tag, dict(keep or {})
    for key, value in element.attrib.items():
        if key in NUMBERS.get(tag, {}):
            kept[key] = " ".join(map(repr, numbers(element, key, NUMBERS[tag][key], where, owner or element).tolist()))
        elif key in WORDS.get(tag, {}):
            if value not in WORDS[tag][key]:
                raise RobotError(f"{tag} {key}='{value[:60]}' is unknown", where=where, choices=WORDS[tag][key])
            kept[key] = value
        elif key in NAMES.get(tag, ()) or (tag == "geom" and key == "size"):
            kept[key] = value
    element.attrib.clear()
    element.attrib.update(kept)


def _unique(bodies: list[Element], where: str) -> None:
    for kind, names in (("bodies", _names(bodies)), ("joints", _names(j for b in bodies for j in b.findall("joint")))):
        seen: set[str] = set()
        for name in names:
            if name in seen:
                raise RobotError(f"two {kind} are named {name}", where=where)
            seen.add(name)


def _names(elements: Iterator[Element] | list[Element]) -> Iterator[str]:
    return (element.get("name", "") for element in elements)
