"""PyBullet: an exported URDF with the script that lies beside it, or a URDF as PyBullet alone reads it."""

from __future__ import annotations

from pathlib import Path
from typing import Any, final

from lagnet.simulation.pybullet_arm import load_pybullet
from lagnet.simulators.engines.engine import Engine, steps_of
from lagnet.types import JointVector

STEP = 1e-3  # [s]


@final
class PyBulletEngine(Engine):
    """model.urdf and settings.json of an export."""

    name = "pybullet"

    def __init__(self, folder: Path, step: float | None = None):
        load_pybullet()
        from lagnet.simulators.runtime.run_pybullet import CorrectedArm

        self.step = STEP if step is None else step
        self._arm: Any = CorrectedArm(folder, self.step)

    def put(self, q: JointVector, v: JointVector) -> None:
        self._arm.put(q, v)

    def read(self) -> tuple[JointVector, JointVector]:
        return self._arm.read()

    def advance(self, torque: JointVector, seconds: float) -> None:
        for _ in range(steps_of(seconds, self.step)):
            self._arm.step(torque)

    def close(self) -> None:
        self._arm.close()


@final
class PyBulletUrdfEngine(Engine):
    """model.urdf of an export, as PyBullet reads it: its motors let go, torques act on the joints."""

    name = "pybullet"

    def __init__(self, folder: Path, joints: tuple[str, ...], step: float = STEP):
        engine: Any = load_pybullet()
        self._engine, self.step = engine, step
        self._world = engine.connect(engine.DIRECT)
        flags, model = engine.URDF_USE_INERTIA_FROM_FILE, str(folder / "model.urdf")
        self._body = engine.loadURDF(model, useFixedBase=True, flags=flags, physicsClientId=self._world)
        count = engine.getNumJoints(self._body, self._world)
        names = [engine.getJointInfo(self._body, i, self._world)[1].decode() for i in range(count)]
        self._ids = [names.index(n) for n in joints]
        for link in range(-1, count):
            engine.changeDynamics(self._body, link, linearDamping=0.0, angularDamping=0.0, physicsClientId=self._world)
        for link in range(count):  # without force they let go
            engine.setJointMotorControl2(
                self._body, link, engine.VELOCITY_CONTROL, force=0.0, physicsClientId=self._world
            )
        engine.setGravity(0.0, 0.0, -9.81, physicsClientId=self._world)
        engine.setTimeStep(step, physicsClientId=self._world)

    def put(self, q: JointVector, v: JointVector) -> None:
        for joint, position, speed in zip(self._ids, q, v, strict=True):
            self._engine.resetJointState(self._body, joint, position, speed, physicsClientId=self._world)

    def read(self) -> tuple[JointVector, JointVector]:
        import numpy as np

        states = self._engine.getJointStates(self._body, self._ids, physicsClientId=self._world)
        return np.array([s[0] for s in states]), np.array([s[1] for s in states])

    def advance(self, torque: JointVector, seconds: float) -> None:
        mode, forces = self._engine.TORQUE_CONTROL, [float(x) for x in torque]
        for _ in range(steps_of(seconds, self.step)):
            self._engine.setJointMotorControlArray(
                self._body, self._ids, mode, forces=forces, physicsClientId=self._world
            )
            self._engine.stepSimulation(physicsClientId=self._world)

    def close(self) -> None:
        if self._world >= 0:
            self._engine.disconnect(self._world)
            self._world = -1
