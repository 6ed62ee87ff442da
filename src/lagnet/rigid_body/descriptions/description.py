"""What is read from a file before any physics is asked of it: the model, its joints, limits and where it came from."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from lagnet.errors import RobotError
from lagnet.rigid_body.descriptions.xml_files import XmlFile
from lagnet.rigid_body.untyped_pinocchio import Model, pin

NONE_HELD: Mapping[str, float] = MappingProxyType({})


@dataclass(frozen=True, eq=False)
class Description:
    """A fixed-base arm of one-degree-of-freedom joints.

    Args:
        model: kinematics and inertias; every joint has one position variable, continuous joints an angle.
        joint_types: 'revolute', 'continuous' or 'prismatic' of each joint.
        links: name of the moving body behind each joint.
        link_inertials: link name and ten inertial parameters in the link's own frame, as the file gives them, before
            links behind fixed joints are merged into the moving body.
        kind: 'urdf', 'mjcf' or 'named_robot'.
        source: path or name that was asked for.
        file: the file's bytes.
        held: joints of the file that are held still, and the position they are held at.
        warnings: what the reader noticed and survived.
    """

    model: Model
    joint_types: tuple[str, ...]
    links: tuple[str, ...]
    link_inertials: tuple[tuple[str, np.ndarray], ...]
    kind: str
    source: str
    file: XmlFile
    held: tuple[tuple[str, float], ...] = ()
    warnings: tuple[str, ...] = ()


def moving_bodies(model: Model) -> tuple[str, ...]:
    """Name of the first body frame on each joint: the link that the joint moves; others behind it are welded on."""
    names = {}
    for frame in model.frames:
        if frame.type == pin.FrameType.BODY:
            names.setdefault(frame.parentJoint, frame.name)
    return tuple(names.get(i, model.names[i]) for i in range(1, model.njoints))


def check_held(held: Mapping[str, float], joints: Iterable[str], where: str) -> list[str]:
    """What is said of joints that the user wants held still [rad or m].

    Raises:
        RobotError: no such joint, or a position that is no number.
    """
    known = list(joints)
    for name, position in held.items():
        if name not in known:
            raise RobotError(f"has no joint {name} to hold", where=where, choices=known)
        if not np.isfinite(position):
            raise RobotError(f"joint {name} cannot be held at {position}", where=where, next_step="give a number")
    return [f"joint {name} is held at {position:g}" for name, position in held.items()]


def friction_warning(joints: Iterable[str]) -> list[str]:
    """What is said of declared friction: the torque it would explain must stay visible in a comparison."""
    names = ", ".join(joints)
    if not names:
        return []
    return [f"damping or friction declared on {names} is not part of the rigid bodies and is left out"]
