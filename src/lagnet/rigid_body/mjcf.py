"""MJCF to a Pinocchio model: bodies, joints and inertials alone; nothing that opens another file."""

from __future__ import annotations

import tempfile
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]

from lagnet.errors import RobotError
from lagnet.rigid_body.description import Description, friction_warning, moving_bodies
from lagnet.rigid_body.mass_checks import mass_warnings
from lagnet.rigid_body.xml_files import XmlFile

KEPT = ("compiler", "default", "option", "worldbody")
FILES = ("file", "meshdir", "texturedir", "assetdir")
SUPPORTED = ("hinge", "slide")


def read_mjcf(file: XmlFile) -> Description:
    """The arm of an MJCF file whose bodies state their inertials, or have plain shapes to take them from.

    Raises:
        RobotError: naming the file and the body or joint at fault.
    """
    root, where = file.root(), file.source
    warnings = _simplify(root, where)
    model = _build(root, where)
    option = root.find("option")
    if option is not None and option.get("gravity"):
        model.gravity.linear = _numbers(option, "gravity", 3, where)
    for i in range(1, model.njoints):
        if model.joints[i].nq != 1 or model.joints[i].nv != 1:
            raise RobotError(f"joint {model.names[i]} has no single position", where=where, choices=SUPPORTED)
    if model.nv == 0:
        raise RobotError("has no moving joint", where=where)
    types = tuple(_type(model, i) for i in range(1, model.njoints))
    _check_finite(model, where)
    warnings += _friction_warnings(model) + mass_warnings(model, where)
    return Description(model, types, moving_bodies(model), (), "mjcf", where, file, (), tuple(warnings))


def _simplify(root: Element, where: str) -> list[str]:
    """Removes what is not kinematics or inertia, and refuses what would open other files or change the physics."""
    for element in root.iter():
        if element.tag in ("include", "model", "attach", "plugin"):
            raise RobotError(f"<{element.tag}> is refused: one file must hold the whole arm", where=where)
    warnings = [f"<{tag}> is left out" for tag in ("equality", "tendon") if root.find(tag) is not None]
    for child in list(root):
        if child.tag not in KEPT:
            root.remove(child)
        for key in FILES:
            child.attrib.pop(key, None)
    compiler = root.find("compiler")
    if compiler is not None and compiler.get("inertiafromgeom") == "true":
        raise RobotError("inertiafromgeom is set: inertials are needed in the file", where=where)
    world = root.find("worldbody")
    if world is None:
        raise RobotError("has no <worldbody>", where=where)
    for body in world.iter("body"):
        warnings += _simplify_body(body, where)
    for geom in world.findall("geom"):
        world.remove(geom)
    return warnings


def _simplify_body(body: Element, where: str) -> list[str]:
    name, warnings = body.get("name", "without a name"), []
    joints = [part for part in body if part.tag in ("joint", "freejoint")]
    for joint in joints:
        kind = "free" if joint.tag == "freejoint" else joint.get("type", "hinge")
        if kind not in SUPPORTED:
            what = f"joint {joint.get('name', '')} of body {name} is of type '{kind}', which has no single position"
            raise RobotError(what, where=where, choices=SUPPORTED)
    if len(joints) > 1:
        raise RobotError(f"body {name} has {len(joints)} joints; give each its own body", where=where)
    has_inertial = body.find("inertial") is not None
    for part in list(body):
        if part.tag == "geom" and not has_inertial and (part.get("type") == "mesh" or part.get("mesh")):
            raise RobotError(f"body {name} has a mesh and no <inertial>", where=where, next_step="state its inertial")
        if (part.tag == "geom" and has_inertial) or part.tag in ("camera", "light"):
            body.remove(part)
    return warnings


def _build(root: Element, where: str) -> pin.Model:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "arm.xml"
        path.write_bytes(ElementTree.tostring(root))
        try:
            return pin.buildModelFromMJCF(str(path))
        except Exception as error:  # the parser raises bare exceptions of several kinds
            raise RobotError(f"is not an MJCF that can be built ({str(error).strip()})", where=where) from error


def _friction_warnings(model: pin.Model) -> list[str]:
    friction = zip(model.names[1:], model.damping, model.friction, strict=True)
    return friction_warning(name for name, damping, dry in friction if damping or dry)


def _type(model: pin.Model, i: int) -> str:
    if "Prismatic" in model.joints[i].shortname() or model.joints[i].shortname()[10:] in ("PX", "PY", "PZ"):
        return "prismatic"
    k = model.joints[i].idx_q
    bounded = np.isfinite(model.lowerPositionLimit[k]) and np.isfinite(model.upperPositionLimit[k])
    return "revolute" if bounded else "continuous"


def _numbers(element: Element, key: str, count: int, where: str) -> np.ndarray:
    try:
        values = np.array([float(x) for x in element.get(key, "").split()])
    except ValueError:
        values = np.empty(0)
    if values.size != count or not np.isfinite(values).all():
        raise RobotError(f"<{element.tag}> {key}='{element.get(key, '')[:60]}' is not {count} numbers", where=where)
    return values


def _check_finite(model: pin.Model, where: str) -> None:
    for i in range(1, model.njoints):
        body = model.inertias[i]
        found = [body.mass, *body.lever, *body.inertia.ravel(), *model.jointPlacements[i].homogeneous.ravel()]
        if not np.isfinite(found).all():
            raise RobotError(f"joint {model.names[i]} or its body holds a number that is not finite", where=where)
