"""One fixed arm in a PyBullet world of its own, without a window, meshes, motors, damping or joint stops."""

from __future__ import annotations

import os
import tempfile
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np

from lagnet.errors import MissingExtraError
from lagnet.rigid_body.robot import Robot
from lagnet.types import JointVector


def load_pybullet() -> Any:
    """The engine.

    Raises:
        MissingExtraError: it is not installed.
    """
    try:
        with _hushed():
            import pybullet  # pyright: ignore[reportMissingImports]
    except ImportError:
        raise MissingExtraError("PyBullet is not installed", next_step="pip install 'lagnet[simulation]'") from None
    return pybullet


@contextmanager
def _hushed() -> Iterator[None]:
    """The engine prints its build time on standard error when it is loaded, which belongs to our own messages."""
    kept, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)


class PyBulletArm:
    """The rigid bodies of a robot under joint torques; joint vectors are in the robot's order.

    The engine steps semi-implicitly: v ← v + h a(q, v, τ), then q ← q + h v. A speed therefore belongs half a step
    before the position beside it, and the second difference of positions around an instant is the acceleration that the
    torque of that same instant made.

    Args:
        robot: its bodies and gravity.
        step: [s].

    Raises:
        MissingExtraError: PyBullet is not installed.
        RobotError: the arm cannot be written as a URDF, or has a joint with nothing that has mass behind it.
    """

    def __init__(self, robot: Robot, step: float):
        self._engine = load_pybullet()
        robot.require_mass()
        self.step = step
        self._world = self._engine.connect(self._engine.DIRECT)
        try:
            self._load(robot)
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> PyBulletArm:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Give the world back; closing twice does no harm."""
        if self._world >= 0:
            self._engine.disconnect(self._world)
            self._world = -1

    def _load(self, robot: Robot) -> None:
        engine = self._engine
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "arm.urdf"
            robot.write_bare_urdf(path)
            _made_free(path)
            flags = engine.URDF_USE_INERTIA_FROM_FILE
            self._arm = engine.loadURDF(str(path), useFixedBase=True, flags=flags, physicsClientId=self._world)
        n_links = engine.getNumJoints(self._arm, self._world)
        info = [engine.getJointInfo(self._arm, i, self._world) for i in range(n_links)]
        moving = [i for i in info if i[2] != engine.JOINT_FIXED]
        names = [i[1].decode() for i in moving]
        self._ids = [i[0] for i in moving]
        self._from_engine = [names.index(name) for name in robot.joints]
        self._to_engine = [robot.joints.index(name) for name in names]
        self._settle(n_links, robot.gravity)

    def _settle(self, n_links: int, gravity: np.ndarray) -> None:
        engine = self._engine
        for link in range(-1, n_links):
            engine.changeDynamics(self._arm, link, maxJointVelocity=1e3, physicsClientId=self._world)
        self.damp(0.0, 0.0, 0.0)
        still = [0.0] * len(self._ids)  # the default motors hold every joint; without force they let go
        mode = engine.VELOCITY_CONTROL
        engine.setJointMotorControlArray(self._arm, self._ids, mode, forces=still, physicsClientId=self._world)
        engine.setGravity(*map(float, gravity), physicsClientId=self._world)
        engine.setTimeStep(self.step, physicsClientId=self._world)

    def _read(self, values: Sequence[float]) -> np.ndarray:
        return np.array(values)[self._from_engine]

    def _written(self, values: JointVector) -> list[float]:
        return values[self._to_engine].tolist()

    def put(self, q: JointVector, v: JointVector) -> None:
        """Set the state: positions [rad], and speeds half a step before them [rad/s]."""
        for joint, position, speed in zip(self._ids, self._written(q), self._written(v), strict=True):
            self._engine.resetJointState(self._arm, joint, position, speed, physicsClientId=self._world)

    def state(self) -> tuple[JointVector, JointVector]:
        """Positions [rad], and speeds half a step before them [rad/s]."""
        states = self._engine.getJointStates(self._arm, self._ids, physicsClientId=self._world)
        return self._read([s[0] for s in states]), self._read([s[1] for s in states])

    def damp(self, linear: float, angular: float, joint: float) -> None:
        """Let motion die away as the engine has it; seen by `advance` alone, not by `mass_matrix` or `bias_torque`.

        Args:
            linear, angular: rates at which every body loses translation and rotation [1/s].
            joint: torque per speed of every joint [N m s/rad].
        """
        lost = {"linearDamping": linear, "angularDamping": angular, "jointDamping": joint}
        for link in range(-1, self._engine.getNumJoints(self._arm, self._world)):
            self._engine.changeDynamics(self._arm, link, physicsClientId=self._world, **lost)

    def mass_matrix(self, q: JointVector) -> np.ndarray:
        """Joint-space inertia [kg m²], shape (dof, dof)."""
        M = np.array(self._engine.calculateMassMatrix(self._arm, self._written(q), physicsClientId=self._world))
        return M[np.ix_(self._from_engine, self._from_engine)]

    def bias_torque(self, q: JointVector, v: JointVector) -> JointVector:
        """Gravity, centrifugal and Coriolis torque [N m]."""
        rest = [0.0] * len(self._ids)
        given = self._arm, self._written(q), self._written(v), rest
        return self._read(self._engine.calculateInverseDynamics(*given, physicsClientId=self._world))

    def advance(self, torque: JointVector) -> None:
        """Let one step pass under joint torques [N m]."""
        engine, forces = self._engine, self._written(torque)
        mode = engine.TORQUE_CONTROL
        engine.setJointMotorControlArray(self._arm, self._ids, mode, forces=forces, physicsClientId=self._world)
        engine.stepSimulation(physicsClientId=self._world)


def _made_free(path: Path) -> None:
    """Take out stops and torque caps, and give links without a body none: the engine would make up 1 kg for each.

    Wanted motions keep the limits by themselves; limits inside the engine would add physics that nobody asked for.
    """
    tree = ElementTree.parse(path)
    for limit in tree.getroot().iter("limit"):
        limit.attrib.update(lower="-1000", upper="1000", effort="1e9", velocity="1e6")
    for link in tree.getroot().iter("link"):
        if link.find("inertial") is None:
            inertial = ElementTree.SubElement(link, "inertial")
            ElementTree.SubElement(inertial, "mass", value="0")
            ElementTree.SubElement(inertial, "inertia", {k: "0" for k in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")})
    tree.write(path)
