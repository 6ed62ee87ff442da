"""Reduces MJCF to what an arm needs, and refuses what would open another file or is no arm of simple joints."""

from __future__ import annotations

from collections.abc import Iterable
from xml.etree.ElementTree import Element

from lagnet.errors import RobotError
from lagnet.rigid_body.descriptions.urdf_checks import MAX_JOINTS

SUPPORTED = ("hinge", "slide")
KEPT = ("compiler", "default", "option", "worldbody")
LEFT_OUT = ("equality", "tendon")  # said aloud: they would change the motion
REFUSED = ("include", "model", "attach", "plugin", "frame", "replicate", "composite", "flexcomp")
COMPILER_WORDS = {"angle": ("degree", "radian"), "autolimits": ("true", "false")}


def reduce_mjcf(root: Element, where: str) -> list[str]:
    """Strips the tree to bodies, joints, inertials, shapes and their defaults, in place; names what has no name.

    Returns:
        Warnings on what was left out.

    Raises:
        RobotError: what would open another file, or is no arm of simple joints.
    """
    for element in root.iter():
        if element.tag in REFUSED:
            raise RobotError(f"<{element.tag}> is refused: one file must spell out the whole arm", where=where)
    warnings = [f"<{tag}> is left out" for tag in LEFT_OUT if len(root.findall(tag))]
    _keep(root, KEPT)
    world = root.find("worldbody")
    if world is None:
        raise RobotError("has no <worldbody>", where=where)
    _check_compiler(root.findall("compiler"), where)
    bodies = list(world.iter("body"))
    if not any(body.find("joint") is not None or body.find("freejoint") is not None for body in bodies):
        raise RobotError("has no moving joint", where=where)
    if len(bodies) > MAX_JOINTS:
        raise RobotError(f"has {len(bodies)} bodies, more than {MAX_JOINTS}", where=where)
    for k, body in enumerate(bodies):
        _check_body(body, k, where)
    _unique("bodies", bodies, where)
    _unique("joints", [joint for body in bodies for joint in body.findall("joint")], where)
    return warnings


def _keep(element: Element, tags: tuple[str, ...]) -> None:
    for child in list(element):
        if child.tag not in tags:
            element.remove(child)


def _check_compiler(compilers: list[Element], where: str) -> None:
    for compiler in compilers:
        if compiler.get("coordinate") == "global":
            raise RobotError("compiler coordinate='global' is not supported: give local frames", where=where)
        if compiler.get("settotalmass") is not None:
            raise RobotError("compiler settotalmass is not supported: state the masses", where=where)
        sequence = compiler.get("eulerseq", "xyz")
        if len(sequence) != 3 or set(sequence) - set("xyzXYZ"):
            raise RobotError(f"compiler eulerseq='{sequence[:20]}' is not three axes", where=where)
        for key, words in COMPILER_WORDS.items():
            if compiler.get(key, words[0]) not in words:
                raise RobotError(
                    f"compiler {key}='{compiler.get(key, '')[:60]}' is unknown", where=where, choices=words
                )


def _check_body(body: Element, k: int, where: str) -> None:
    name = body.get("name") or f"body_{k}"
    body.set("name", name)
    _keep(body, ("body", "joint", "freejoint", "geom", "inertial"))
    joints, inertials = body.findall("joint"), body.findall("inertial")
    if body.find("freejoint") is not None:
        what = f"body {name} has a joint of type 'free', which has no single position"
        raise RobotError(what, where=where, choices=SUPPORTED)
    if len(joints) > 1:
        raise RobotError(f"body {name} has {len(joints)} joints; give each its own body", where=where)
    if len(inertials) > 1:
        raise RobotError(f"body {name} has {len(inertials)} inertials", where=where)
    for joint in joints:
        joint.set("name", joint.get("name") or f"joint_{k}")
    for inertial in inertials:
        if inertial.get("mass") is None or not {"diaginertia", "fullinertia"} & set(inertial.attrib):
            raise RobotError(f"the inertial of body {name} lacks mass or inertia", where=where)


def _unique(kind: str, elements: Iterable[Element], where: str) -> None:
    seen: set[str | None] = set()
    for element in elements:
        if element.get("name") in seen:
            raise RobotError(f"two {kind} are named {element.get('name')}", where=where)
        seen.add(element.get("name"))
