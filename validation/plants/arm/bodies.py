"""The arm's rigid bodies in Pinocchio, from the rewritten description, with the interface of the PyBullet bodies."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]

from validation.plants.body import BodySettings, _stripped, gravity_vector, joint_names

WIDE = {"lower": "-1000", "upper": "1000", "effort": "1e9", "velocity": "1e4"}


class PinocchioBodies:
    """Inertia and bias torque of an arm; joint vectors are in model order."""

    def __init__(self, robot: str, settings: BodySettings | None = None) -> None:
        settings = settings or BodySettings()
        root = _stripped(robot, settings)
        for joint in root.iter("joint"):
            if joint.get("type") == "continuous":  # one angle, not a point on the circle
                joint.set("type", "revolute")
                ElementTree.SubElement(joint, "limit", WIDE)
        self.model = pin.buildModelFromXML(ElementTree.tostring(root, encoding="unicode"))
        self.joints = joint_names(robot)
        if tuple(self.model.names[1:]) != self.joints or self.model.nq != self.model.nv:
            raise ValueError(f"{robot}: joints {tuple(self.model.names[1:])}, expected {self.joints}")
        self.model.gravity.linear = gravity_vector(settings.tilt)
        self.data = self.model.createData()

    def inertia(self, q: np.ndarray) -> np.ndarray:
        """Joint-space inertia [kg m²], shape (dof, dof)."""
        return pin.crba(self.model, self.data, q)

    def bias(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Gravity, centrifugal and Coriolis torque [N m]."""
        return pin.nonLinearEffects(self.model, self.data, q, v)

    def gravity(self, q: np.ndarray) -> np.ndarray:
        """Torque that holds the arm still [N m]."""
        return pin.computeGeneralizedGravity(self.model, self.data, q)

    def torque(self, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        """Inverse dynamics of many samples, shape (n, dof) [N m]."""
        return np.stack([pin.rnea(self.model, self.data, *row) for row in zip(q, v, a, strict=True)])

    def link_columns(self, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        """Torque per inertial parameter of every link, shape (n, dof, 10 links)."""
        rows = zip(q, v, a, strict=True)
        return np.stack([pin.computeJointTorqueRegressor(self.model, self.data, *row).copy() for row in rows])
