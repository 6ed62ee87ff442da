"""Numbers, rotations and whole XML files as text."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np
from scipy.spatial.transform import Rotation

from lagnet.rigid_body.descriptions.writing import write_text


def number(value: float) -> str:
    """A number that reads back as itself."""
    return repr(float(value))


def numbers(values: np.ndarray) -> str:
    """Numbers with blanks between them."""
    return " ".join(number(v) for v in np.ravel(values))


def quaternion(rotation: np.ndarray) -> np.ndarray:
    """Unit quaternion (w, x, y, z) of a rotation of shape (3, 3), shape (4,)."""
    return Rotation.from_matrix(rotation).as_quat(canonical=True)[[3, 0, 1, 2]]


def roll_pitch_yaw(rotation: np.ndarray) -> np.ndarray:
    """Angles about fixed x, y, z of a rotation of shape (3, 3), shape (3,) [rad]."""
    return Rotation.from_matrix(rotation).as_euler("xyz")


def write_xml(path: Path, root: Element) -> None:
    """Writes the file whole or not at all."""
    ElementTree.indent(root)
    write_text(path, ElementTree.tostring(root, encoding="unicode") + "\n")
