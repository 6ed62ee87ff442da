"""Robots that come with example-robot-data, by name, and which of their joints a user does not expect in an arm."""

from __future__ import annotations

import os
from difflib import get_close_matches
from pathlib import Path

from lagnet.errors import RobotError

# Gripper joints of the named robots are held at zero: recordings of these arms have one column per arm joint.
# Ask for the URDF by its path to keep them.
HELD_JOINTS = {
    "panda": ("panda_finger_joint1", "panda_finger_joint2"),
    "panda_collision": ("panda_finger_joint1", "panda_finger_joint2"),
    "bravo7_gripper": ("bravo_finger1_joint", "bravo_finger2_joint"),
    "bluevolta_bravo7_gripper": ("bravo_finger1_joint", "bravo_finger2_joint"),
    "falcon_bravo7_gripper": ("bravo_finger1_joint", "bravo_finger2_joint"),
    "so100": ("gripper",),
    "so101": ("gripper",),
    "talos_arm": ("gripper_left_joint",),
    "z1": ("jointGripper",),
}
ARMS_ON_A_FLOATING_BASE = ("so100", "so101")  # desk arms that the collection marks as floating
WRONG_IN_THE_COLLECTION = {"ur3": ("ur_description", "urdf", "ur3_robot.urdf")}  # its table gives the UR-5 for "ur3"


def named_robots() -> tuple[str, ...]:
    """Names of the arms and other fixed-base robots of example-robot-data."""
    robots = _table()
    return tuple(n for n, c in sorted(robots.items()) if not c.free_flyer or n in ARMS_ON_A_FLOATING_BASE)


def named_robot_path(name: str) -> Path:
    """URDF file of a named robot; no mesh is opened.

    Raises:
        RobotError: unknown name, a robot without a URDF, or one with a floating base.
    """
    robots = _table()
    if name not in robots:
        raise RobotError(
            f"'{name}' is neither a file nor a known robot{_did_you_mean(name, robots)}",
            choices=named_robots(),
            next_step="give one of these names, or the path of a URDF (.urdf) or MJCF (.xml) file",
        )
    if name not in named_robots():
        raise RobotError(f"'{name}' has a floating base; only fixed-base robots are supported", choices=named_robots())
    loader = robots[name]
    parts = WRONG_IN_THE_COLLECTION.get(name, (loader.path, loader.urdf_subpath, loader.urdf_filename))
    return _collection() / Path(*parts)


def _did_you_mean(name: str, robots: dict) -> str:
    found = get_close_matches(name.lower(), list(robots), n=3, cutoff=0.5)
    return f"; did you mean {' or '.join(found)}?" if found else ""


def _table() -> dict:
    from example_robot_data.robots_loader import ROBOTS  # pyright: ignore[reportMissingImports]

    return {n: c for n, c in ROBOTS.items() if c.urdf_filename}


def _collection() -> Path:
    from example_robot_data.robots_loader import getModelPath  # pyright: ignore[reportMissingImports]

    return Path(os.path.realpath(getModelPath("ur_description")))
