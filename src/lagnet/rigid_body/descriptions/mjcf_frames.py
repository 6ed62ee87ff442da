"""Placements and inertias as MJCF writes them: five ways to turn a frame, and bodies made of plain shapes."""

from __future__ import annotations

from dataclasses import dataclass
from xml.etree.ElementTree import Element

import numpy as np

from lagnet.errors import RobotError
from lagnet.rigid_body.descriptions.urdf_checks import numbers
from lagnet.rigid_body.untyped_pinocchio import SE3, Inertia, pin

DENSITY = "1000"  # [kg/m³], MuJoCo's default
SIZES = {"sphere": 1, "capsule": 2, "cylinder": 2, "box": 3, "ellipsoid": 3}
TURNS = ("quat", "axisangle", "xyaxes", "zaxis", "euler")


@dataclass(frozen=True)
class Reading:
    """How the file writes angles, and its name for errors."""

    where: str
    degrees: bool = True
    sequence: str = "xyz"

    def angle(self, value: np.ndarray | float) -> np.ndarray:
        """An angle of the file in rad."""
        return np.deg2rad(value) if self.degrees else np.asarray(value, dtype=float)


def placement(element: Element, owner: Element, reading: Reading) -> SE3:
    """Placement of a body, inertial or shape in its parent."""
    position = numbers(element, "pos", 3, reading.where, owner, "0 0 0")
    given = [key for key in TURNS if element.get(key) is not None]
    if len(given) > 1:
        raise RobotError(
            f"body {owner.get('name')}: {element.tag} is turned by {' and '.join(given)}", where=reading.where
        )
    rotation = _rotation(given[0], element, owner, reading) if given else np.eye(3)
    return pin.SE3(rotation, position)


def _rotation(key: str, element: Element, owner: Element, reading: Reading) -> np.ndarray:
    count = {"quat": 4, "axisangle": 4, "xyaxes": 6, "zaxis": 3, "euler": 3}[key]
    values = numbers(element, key, count, reading.where, owner)
    if key == "euler":
        return _euler(reading.angle(values), reading.sequence)
    if key == "quat":
        w, x, y, z = _unit(values, key, owner, reading)
        return pin.Quaternion(w, x, y, z).toRotationMatrix()
    if key == "axisangle":
        return pin.exp3(_unit(values[:3], key, owner, reading) * reading.angle(values[3]))
    if key == "xyaxes":
        x = _unit(values[:3], key, owner, reading)
        y = _unit(values[3:] - (values[3:] @ x) * x, key, owner, reading)
        return np.column_stack([x, y, np.cross(x, y)])
    return _least_turn(_unit(values, key, owner, reading))


def _unit(values: np.ndarray, key: str, owner: Element, reading: Reading) -> np.ndarray:
    length = float(np.linalg.norm(values))
    if length < 1e-9:
        raise RobotError(f"body {owner.get('name')}: {key} has length zero", where=reading.where)
    return values / length


def _euler(angles: np.ndarray, sequence: str) -> np.ndarray:
    """Small letters turn about axes that move along, capitals about fixed ones."""
    rotation = np.eye(3)
    for letter, angle in zip(sequence, angles, strict=True):
        turn = pin.exp3(angle * np.eye(3)["xyz".index(letter.lower())])
        rotation = rotation @ turn if letter.islower() else turn @ rotation
    return rotation


def _least_turn(z: np.ndarray) -> np.ndarray:
    """The smallest rotation that carries the z axis to the given direction."""
    axis = np.cross([0.0, 0.0, 1.0], z)
    sine = float(np.linalg.norm(axis))
    if sine < 1e-12:
        return np.eye(3) if z[2] > 0 else np.diag([1.0, -1.0, -1.0])
    return pin.exp3(axis / sine * np.arctan2(sine, z[2]))


def stated_inertia(inertial: Element, owner: Element, reading: Reading) -> Inertia:
    """The body of an `inertial` element, in the frame of its owner."""
    (mass,) = numbers(inertial, "mass", 1, reading.where, owner)
    if inertial.get("fullinertia") is not None:
        xx, yy, zz, xy, xz, yz = numbers(inertial, "fullinertia", 6, reading.where, owner)
        tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    else:
        tensor = np.diag(numbers(inertial, "diaginertia", 3, reading.where, owner))
    place = placement(inertial, owner, reading)
    return _body(mass, place, tensor, owner, reading)


def shape_inertia(shape: Element, owner: Element, reading: Reading) -> Inertia:
    """The body of a plain solid shape, in the frame of its owner."""
    kind = shape.get("type", "sphere")
    if kind not in SIZES or shape.get("mesh") is not None:
        what = f"body {owner.get('name')} has a shape of type '{kind[:60]}' and no <inertial>"
        raise RobotError(what, where=reading.where, next_step="state its inertial")
    place, size = _placed_shape(shape, kind, owner, reading)
    volume, moments = _solid(kind, size)
    (density,) = numbers(shape, "density", 1, reading.where, owner, DENSITY)
    mass = density * volume
    if shape.get("mass") is not None:
        (mass,) = numbers(shape, "mass", 1, reading.where, owner)
    return _body(mass, place, np.diag(mass * moments), owner, reading)


def _body(mass: float, place: SE3, tensor: np.ndarray, owner: Element, reading: Reading) -> Inertia:
    """A body of that mass and inertia tensor about its centre, in the frame of its owner.

    Raises:
        RobotError: no body has such a mass or tensor.
    """
    try:
        return pin.Inertia(mass, place.translation, place.rotation @ tensor @ place.rotation.T)
    except (RuntimeError, ValueError):
        what = f"body {str(owner.get('name'))[:60]} has a mass of {mass:.4g} kg or moments of inertia that no body has"
        raise RobotError(
            what, where=reading.where, next_step="mass and principal moments must not be negative"
        ) from None


def _placed_shape(shape: Element, kind: str, owner: Element, reading: Reading) -> tuple[SE3, np.ndarray]:
    text = shape.get("size", "").split()
    count = SIZES[kind]
    if shape.get("fromto") is None:
        size = numbers(shape, "size", max(count, len(text)) if len(text) <= 3 else count, reading.where, owner)
        return placement(shape, owner, reading), size[:count]
    if kind not in ("capsule", "cylinder"):
        raise RobotError(f"body {owner.get('name')}: fromto is read for capsules and cylinders", where=reading.where)
    ends = numbers(shape, "fromto", 6, reading.where, owner).reshape(2, 3)
    radius = numbers(shape, "size", max(1, min(len(text), 3)), reading.where, owner)[0]
    along = ends[1] - ends[0]
    turn = _least_turn(_unit(along, "fromto", owner, reading))
    return pin.SE3(turn, ends.mean(axis=0)), np.array([radius, np.linalg.norm(along) / 2])


def _solid(kind: str, size: np.ndarray) -> tuple[float, np.ndarray]:
    """Volume of a solid, and its principal moments per mass; sizes are radii and half lengths."""
    if kind in ("box", "ellipsoid"):
        square = size**2
        share = 1 / 3 if kind == "box" else 1 / 5
        volume = (8.0 if kind == "box" else 4 / 3 * np.pi) * float(np.prod(size))
        return volume, share * (square.sum() - square)
    if kind == "sphere":
        return 4 / 3 * np.pi * float(size[0]) ** 3, np.full(3, 0.4 * size[0] ** 2)
    r, h = map(float, size)
    tube, caps = 2 * np.pi * r**2 * h, 4 / 3 * np.pi * r**3 * (kind == "capsule")
    across = tube * (r**2 / 4 + h**2 / 3) + caps * (0.4 * r**2 + h**2 + 0.75 * h * r)
    along = tube * r**2 / 2 + caps * 0.4 * r**2
    return tube + caps, np.array([across, across, along]) / max(tube + caps, np.finfo(float).tiny)
