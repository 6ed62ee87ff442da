"""Friction that a robot's own file declares: damping and dry friction of URDF and MJCF, which bodies leave out."""

from __future__ import annotations

from xml.etree.ElementTree import Element

import numpy as np

from lagnet.rigid_body.descriptions.urdf_checks import numbers
from lagnet.rigid_body.mjcf_actuators import position_actuators
from lagnet.rigid_body.robot import Robot

URDF_KEYS, MJCF_KEYS = ("damping", "friction"), ("viscous", "coulomb")


def declared_friction(robot: Robot) -> np.ndarray:
    """Viscous [N m s/rad] and dry friction [N m] of every joint, shape (dof, 2); zero where none is declared.

    Raises:
        RobotError: a number in the file that is none.
    """
    out = np.zeros((robot.n_dof, 2))
    if robot.kind == "mjcf":
        for name, values in position_actuators(robot)[0].items():
            out[robot.joints.index(name)] = [values[key] for key in MJCF_KEYS]
        return out
    for joint in robot._description.file.root().iter("joint"):
        name, dynamics = joint.get("name", ""), joint.find("dynamics")
        if dynamics is not None and name in robot.joints:
            out[robot.joints.index(name)] = [_number(dynamics, key, robot.source) for key in URDF_KEYS]
    return out


def _number(element: Element, key: str, where: str) -> float:
    return float(numbers(element, key, 1, where, element, "0")[0])
