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
from lagnet.rigid_body.mjcf_checks import SUPPORTED, reduce_mjcf
from lagnet.rigid_body.urdf_checks import LARGEST, numbers
from lagnet.rigid_body.xml_files import XmlFile


def read_mjcf(file: XmlFile) -> Description:
    """The arm of an MJCF file whose bodies state their inertials, or have plain shapes to take them from.

    Raises:
        RobotError: naming the file and the body or joint at fault.
    """
    root, where = file.root(), file.source
    gravity = [numbers(o, "gravity", 3, where, o) for o in root.findall("option") if o.get("gravity") is not None]
    warnings = reduce_mjcf(root, where)
    model = _build(root, where)
    if gravity:
        model.gravity.linear = gravity[-1]
    for i in range(1, model.njoints):
        if model.joints[i].nq != 1 or model.joints[i].nv != 1:
            raise RobotError(f"joint {model.names[i]} has no single position", where=where, choices=SUPPORTED)
    if model.nv == 0:
        raise RobotError("has no moving joint", where=where)
    types = tuple(_type(model, i) for i in range(1, model.njoints))
    _check_finite(model, where)
    warnings += _friction_warnings(model) + mass_warnings(model, where)
    links = moving_bodies(model)
    inertials = tuple((link, model.inertias[i + 1].toDynamicParameters()) for i, link in enumerate(links))
    return Description(model, types, links, inertials, "mjcf", where, file, (), tuple(warnings))


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


def _check_finite(model: pin.Model, where: str) -> None:
    for i in range(1, model.njoints):
        body = model.inertias[i]
        found = [body.mass, *body.lever, *body.inertia.ravel(), *model.jointPlacements[i].homogeneous.ravel()]
        if not np.isfinite(found).all() or np.abs(found).max() > LARGEST:
            raise RobotError(f"joint {model.names[i]} or its body holds a number that no robot has", where=where)
