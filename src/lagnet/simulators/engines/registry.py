"""Engines by name, and which files each of them runs."""

from __future__ import annotations

from pathlib import Path

from lagnet.errors import LagnetError
from lagnet.simulators.engines.engine import Engine
from lagnet.simulators.engines.mujoco_engine import MujocoEngine, MujocoUrdfEngine
from lagnet.simulators.engines.pybullet_engine import PyBulletEngine, PyBulletUrdfEngine

ENGINES = ("mujoco", "pybullet")
FORMAT = {"mujoco": "mjcf", "pybullet": "pybullet"}  # what is written for an engine that replays


def engine_of(exporter: str, engine: str, folder: Path, joints: tuple[str, ...], step: float | None = None) -> Engine:
    """An engine that runs what an exporter wrote.

    Args:
        exporter: name of the exporter.
        engine: name of the engine.
        folder: what was written.
        joints: names in model order.
        step: [s]; None: that of the file, or 1 ms.

    Raises:
        LagnetError: the engine does not run such files.
        MissingExtraError: the engine is not installed.
    """
    if (exporter, engine) == ("mjcf", "mujoco"):
        return MujocoEngine(folder, step)
    if (exporter, engine) == ("pybullet", "pybullet"):
        return PyBulletEngine(folder, step)
    if (exporter, engine) == ("urdf", "mujoco"):
        return MujocoUrdfEngine(folder, joints, step or 1e-3)
    if (exporter, engine) == ("urdf", "pybullet"):
        return PyBulletUrdfEngine(folder, joints, step or 1e-3)
    raise LagnetError(f"{engine} does not run what {exporter} writes", choices=ENGINES)
