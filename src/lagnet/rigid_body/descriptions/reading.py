"""Finds what a robot is asked for by: a name of example-robot-data, or the path of a URDF or MJCF file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from lagnet.errors import RobotError
from lagnet.rigid_body.descriptions.description import Description
from lagnet.rigid_body.descriptions.mjcf import read_mjcf
from lagnet.rigid_body.descriptions.named_robots import HELD_JOINTS, named_robot_path, named_robots
from lagnet.rigid_body.descriptions.urdf import read_urdf
from lagnet.rigid_body.descriptions.xml_files import read_xml


def read_description(spec: str | Path, held: Mapping[str, float]) -> Description:
    """The description of a named robot, whose grippers are held still at zero, or of a file, as it is given.

    Args:
        spec: a name, or the path of a .urdf or .xml file.
        held: joints that are held still and where [rad or m].

    Raises:
        RobotError: unknown name, unreadable file, or not a fixed-base arm of one-degree-of-freedom joints.
    """
    path, text = Path(spec), str(spec)
    looks_like_a_path = isinstance(spec, Path) or path.suffix != "" or len(path.parts) > 1
    if not looks_like_a_path and (text in named_robots() or not path.exists()):  # a folder "ur5" does not hide the UR-5
        file = read_xml(named_robot_path(text))
        return read_urdf(file, "named_robot", text, {**dict.fromkeys(HELD_JOINTS.get(text, ()), 0.0), **held})
    if path.suffix.lower() == ".xacro":
        raise RobotError("is a xacro file", where=text, next_step="run xacro on it first")
    file = read_xml(path)
    return read_mjcf(file, held) if file.root().tag == "mujoco" else read_urdf(file, held=held)
