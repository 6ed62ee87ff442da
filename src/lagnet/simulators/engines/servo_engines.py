"""Engines in which an exported servo-driven arm follows position commands, by the scripts that lie beside it."""

from __future__ import annotations

from pathlib import Path
from typing import Any, final

from lagnet.errors import LagnetError
from lagnet.simulation.pybullet_arm import load_pybullet
from lagnet.simulators.engines.engine import Engine, steps_of
from lagnet.simulators.engines.mujoco_engine import load_mujoco
from lagnet.types import JointVector


class _ServoEngine(Engine):
    """What both share: `advance` takes commanded positions, shape (dof,) [rad or m]."""

    step: float
    _arm: Any

    def put(self, q: JointVector, v: JointVector) -> None:
        self._arm.put(q, v)

    def read(self) -> tuple[JointVector, JointVector]:
        return self._arm.read()

    def advance(self, torque: JointVector, seconds: float) -> None:
        for _ in range(steps_of(seconds, self.step)):
            self._arm.step(torque)


@final
class MujocoServoEngine(_ServoEngine):
    """model.xml, settings.json and run_servo_mujoco.py of an export."""

    name = "mujoco"

    def __init__(self, folder: Path, step: float):
        load_mujoco()
        from lagnet.simulators.runtime.run_servo_mujoco import ServoArm

        self._arm, self.step = ServoArm(folder, step), step


@final
class PyBulletServoEngine(_ServoEngine):
    """model.urdf, settings.json and run_servo_pybullet.py of an export."""

    name = "pybullet"

    def __init__(self, folder: Path, step: float):
        load_pybullet()
        from lagnet.simulators.runtime.run_servo_pybullet import ServoArm

        self._arm, self.step = ServoArm(folder, step), step

    def close(self) -> None:
        self._arm.close()


def servo_engine(engine: str, folder: Path, step: float) -> Engine:
    """The engine that runs what was written for it.

    Raises:
        LagnetError: there is no such engine.
        MissingExtraError: it is not installed.
    """
    engines = {kind.name: kind for kind in (MujocoServoEngine, PyBulletServoEngine)}
    if engine not in engines:
        raise LagnetError(f"unknown engine {engine!r}", where="--engine", choices=engines)
    return engines[engine](folder, step)
