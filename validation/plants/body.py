"""The arm's bodies in PyBullet: the shipped description, with what the plant hides built into it.

Nothing here comes from lagnet: the description is rewritten as XML (meshes out, payload body in) and loaded anew.
"""

from __future__ import annotations

import io
import tempfile
import xml.etree.ElementTree as ElementTree
from collections.abc import Sequence
from contextlib import redirect_stdout
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import numpy as np
import pybullet
from scipy.spatial.transform import Rotation

GRAVITY = 9.81  # [m/s²], what Pinocchio assumes too
LOCKED = {  # gripper joints that lagnet holds at zero in the arms of these names
    "panda": ("panda_finger_joint1", "panda_finger_joint2"),
    "z1": ("jointGripper",),
}


@dataclass(frozen=True)
class Payload:
    """A point-like load with a small own inertia, bolted to the last arm link.

    Args:
        mass: [kg].
        centre: centre of mass in the frame of the last moving link of the arm [m].
        radius: radius of gyration of the load about its centre [m].
    """

    mass: float
    centre: tuple[float, float, float]
    radius: float = 0.05


@dataclass(frozen=True)
class BodySettings:
    """What the true bodies have that the nominal description has not."""

    payload: Payload | None = None
    tilt: tuple[float, float] = (0.0, 0.0)  # rotation vector of the base about x and y [rad]
    link_changes: tuple[tuple[str, float, tuple[float, float, float]], ...] = ()  # joint, mass factor, centre shift [m]


@dataclass(frozen=True)
class JointLimits:
    """Limits of one joint as the description states them, with usable stand-ins where it states none."""

    name: str
    kind: str
    lower: float
    upper: float
    speed: float
    effort: float


@lru_cache(maxsize=32)
def _shipped(robot: str) -> tuple[str, tuple[str, ...]]:
    with redirect_stdout(io.StringIO()):
        import example_robot_data

        loaded = example_robot_data.load(robot)
    return Path(loaded.urdf).read_text(), tuple(loaded.model.names[1:])


def description(robot: str) -> tuple[ElementTree.Element, tuple[str, ...]]:
    """The URDF that the diagnosis may see, and its joint names in Pinocchio's order."""
    locked = LOCKED.get(robot, ())
    text, names = _shipped(robot)
    root = ElementTree.fromstring(text)
    for joint in root.iter("joint"):
        if joint.get("name") in locked:
            joint.set("type", "fixed")
    return root, tuple(name for name in names if name not in locked)


def joint_names(robot: str) -> tuple[str, ...]:
    """Joint names in model order."""
    return description(robot)[1]


def joint_limits(robot: str) -> tuple[JointLimits, ...]:
    """Limits of every moving joint in model order."""
    root, names = description(robot)
    found = {joint.get("name"): joint for joint in root.iter("joint") if joint.get("type")}
    return tuple(_limits_of(found[name]) for name in names)


def _limits_of(joint: ElementTree.Element) -> JointLimits:
    limit = joint.find("limit")
    stated = {} if limit is None else limit.attrib
    kind = str(joint.get("type"))
    free = kind == "continuous" or "lower" not in stated or float(stated["lower"]) >= float(stated["upper"])
    lower, upper = (-np.pi, np.pi) if free else (float(stated["lower"]), float(stated["upper"]))
    speed = float(stated.get("velocity", 0.0)) or (0.1 if kind == "prismatic" else 1.5)
    return JointLimits(str(joint.get("name")), kind, lower, upper, speed, float(stated.get("effort", 0.0)) or np.inf)


def arm_joints(robot: str) -> tuple[int, ...]:
    """Indices of the joints of the arm itself, without prismatic or gripper fingers."""
    limits = joint_limits(robot)
    return tuple(i for i, j in enumerate(limits) if j.kind != "prismatic" and "ripper" not in j.name)


def _stripped(robot: str, settings: BodySettings) -> ElementTree.Element:
    root, names = description(robot)
    _strip_shapes(root)
    for link in root.iter("link"):
        if link.find("inertial") is None:  # PyBullet would give it 1 kg
            link.append(_inertial(0.0, (0.0, 0.0, 0.0), np.zeros((3, 3))))
    for limit in root.iter("limit"):  # motions keep the limits; stops and caps of the engine would only hide errors
        limit.attrib.update(lower="-1000", upper="1000", effort="1e9", velocity="1e4")
    for joint in root.iter("joint"):  # damping and friction of the file are not part of the nominal model
        for dynamics in joint.findall("dynamics"):
            joint.remove(dynamics)
    children = {j.get("name"): j.find("child").get("link") for j in root.iter("joint") if j.find("child") is not None}
    if settings.payload is not None:
        _bolt(root, children[names[arm_joints(robot)[-1]]], settings.payload)
    for joint, factor, shift in settings.link_changes:
        _change_link(root, children[joint], factor, shift)
    return root


def _strip_shapes(root: ElementTree.Element) -> None:
    for link in root.iter("link"):
        for tag in ("visual", "collision"):
            for shape in link.findall(tag):
                link.remove(shape)


def _inertial(mass: float, centre: Sequence[float], inertia: np.ndarray) -> ElementTree.Element:
    inertial = ElementTree.Element("inertial")
    ElementTree.SubElement(inertial, "origin", xyz=" ".join(f"{x:.12g}" for x in centre), rpy="0 0 0")
    ElementTree.SubElement(inertial, "mass", value=f"{mass:.12g}")
    entries = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}
    ElementTree.SubElement(inertial, "inertia", {k: f"{inertia[ij]:.12g}" for k, ij in entries.items()})
    return inertial


def _bolt(root: ElementTree.Element, parent: str, payload: Payload) -> None:
    body = ElementTree.SubElement(root, "link", name="concealed_load")
    body.append(_inertial(payload.mass, (0, 0, 0), np.eye(3) * payload.mass * payload.radius**2))
    joint = ElementTree.SubElement(root, "joint", name="concealed_bolt", type="fixed")
    ElementTree.SubElement(joint, "origin", xyz=" ".join(f"{x:.12g}" for x in payload.centre), rpy="0 0 0")
    ElementTree.SubElement(joint, "parent", link=parent)
    ElementTree.SubElement(joint, "child", link="concealed_load")


def _change_link(root: ElementTree.Element, name: str, factor: float, shift: Sequence[float]) -> None:
    link = next(link for link in root.iter("link") if link.get("name") == name)
    inertial = link.find("inertial")
    inertial.find("mass").set("value", f"{float(inertial.find('mass').get('value')) * factor:.12g}")
    for key, value in inertial.find("inertia").attrib.items():
        inertial.find("inertia").set(key, f"{float(value) * factor:.12g}")
    origin = inertial.find("origin")
    if origin is None:
        origin = ElementTree.SubElement(inertial, "origin", xyz="0 0 0", rpy="0 0 0")
    centre = np.array([float(x) for x in origin.get("xyz", "0 0 0").split()]) + np.asarray(shift)
    origin.set("xyz", " ".join(f"{x:.12g}" for x in centre))


def gravity_vector(tilt: tuple[float, float]) -> np.ndarray:
    """Gravity in the frame of a base that was turned by the rotation vector (tilt, 0)."""
    return Rotation.from_rotvec([*tilt, 0.0]).inv().apply([0.0, 0.0, -GRAVITY])


@dataclass
class Body:
    """One arm in its own PyBullet world; joint vectors are in model order."""

    robot: str
    settings: BodySettings = field(default_factory=BodySettings)
    step: float = 1 / 2000

    def __post_init__(self) -> None:
        self.joints = joint_names(self.robot)
        self.client = pybullet.connect(pybullet.DIRECT)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "plant.urdf"
            ElementTree.ElementTree(_stripped(self.robot, self.settings)).write(path)
            flags = pybullet.URDF_USE_INERTIA_FROM_FILE
            self.id = pybullet.loadURDF(str(path), useFixedBase=True, flags=flags, physicsClientId=self.client)
        self._prepare()

    def _prepare(self) -> None:
        c = self.client
        info = [pybullet.getJointInfo(self.id, i, physicsClientId=c) for i in range(pybullet.getNumJoints(self.id, c))]
        tree = [i[1].decode() for i in info if i[2] != pybullet.JOINT_FIXED]
        self._order = [tree.index(name) for name in self.joints]  # model order from PyBullet's order
        self._back = [self.joints.index(name) for name in tree]
        self._index = [i[0] for i in info if i[2] != pybullet.JOINT_FIXED]
        for i in range(-1, len(info)):
            damping = {"linearDamping": 0, "angularDamping": 0, "jointDamping": 0, "maxJointVelocity": 1000}
            pybullet.changeDynamics(self.id, i, physicsClientId=c, **damping)
        off = [0.0] * len(self._index)
        velocity = pybullet.VELOCITY_CONTROL  # the default motors hold the joints: force 0 frees them
        pybullet.setJointMotorControlArray(self.id, self._index, velocity, forces=off, physicsClientId=c)
        pybullet.setGravity(*gravity_vector(self.settings.tilt), physicsClientId=c)
        pybullet.setTimeStep(self.step, physicsClientId=c)
        self._same = self._order == list(range(len(self.joints)))

    def _out(self, values: Sequence[float]) -> np.ndarray:
        array = np.array(values)
        return array if self._same else array[self._order]

    def _in(self, values: np.ndarray) -> list[float]:
        return (values if self._same else values[self._back]).tolist()

    def put(self, q: np.ndarray, v: np.ndarray) -> None:
        """Set the state without physics."""
        for index, position, speed in zip(self._index, self._in(q), self._in(v), strict=True):
            pybullet.resetJointState(self.id, index, position, speed, physicsClientId=self.client)

    def state(self) -> tuple[np.ndarray, np.ndarray]:
        """Positions at the instant, velocities half a step before it (the integrator is semi-implicit)."""
        states = pybullet.getJointStates(self.id, self._index, physicsClientId=self.client)
        return self._out([s[0] for s in states]), self._out([s[1] for s in states])

    def inertia(self, q: np.ndarray) -> np.ndarray:
        """Joint-space inertia [kg m²], shape (dof, dof)."""
        M = np.array(pybullet.calculateMassMatrix(self.id, self._in(q), physicsClientId=self.client))
        return M if self._same else M[np.ix_(self._order, self._order)]

    def bias(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Gravity, centrifugal and Coriolis torque [N m]."""
        zero = [0.0] * len(self._index)
        return self._out(
            pybullet.calculateInverseDynamics(self.id, self._in(q), self._in(v), zero, physicsClientId=self.client)
        )

    def link_of(self, joint: int) -> int:
        """The engine's index of the link behind a joint of the model."""
        return self._index[self._order[joint]]

    def point(self, link: int, at: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Place (3,) in the world of a point of a link's frame, and its Jacobian (3, dof), in the present state."""
        c = self.client
        pose = pybullet.getLinkState(self.id, link, computeForwardKinematics=True, physicsClientId=c)
        place = np.array(pose[4]) + Rotation.from_quat(pose[5]).apply(at)
        local = Rotation.from_quat(pose[3]).inv().apply(at)  # from the frame's origin, along the principal axes
        zero = [0.0] * len(self._index)
        J, _ = pybullet.calculateJacobian(self.id, link, local.tolist(), self._in(q), zero, zero, physicsClientId=c)
        J = np.array(J)
        return place, J if self._same else J[:, self._order]

    def push(self, torque: np.ndarray) -> None:
        """Apply joint torques and let one step of forward dynamics pass."""
        mode = pybullet.TORQUE_CONTROL
        pybullet.setJointMotorControlArray(
            self.id, self._index, mode, forces=self._in(torque), physicsClientId=self.client
        )
        pybullet.stepSimulation(physicsClientId=self.client)

    def close(self) -> None:
        """Give the world back."""
        pybullet.disconnect(self.client)
