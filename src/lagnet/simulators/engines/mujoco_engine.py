"""MuJoCo: an exported MJCF by the script that lies beside it, or a URDF as MuJoCo reads it."""

from __future__ import annotations

from pathlib import Path
from typing import Any, final

import numpy as np

from lagnet.errors import MissingExtraError
from lagnet.simulators.engines.engine import Engine, steps_of
from lagnet.types import JointVector


def load_mujoco() -> Any:
    """The engine.

    Raises:
        MissingExtraError: it is not installed.
    """
    try:
        import mujoco  # pyright: ignore[reportMissingImports]
    except ImportError:
        raise MissingExtraError("MuJoCo is not installed", next_step="pip install 'lagnet[mujoco]'") from None
    return mujoco


@final
class MujocoEngine(Engine):
    """model.xml and settings.json of an export."""

    name = "mujoco"

    def __init__(self, folder: Path, step: float | None = None):
        load_mujoco()
        from lagnet.simulators.runtime.run_mujoco import CorrectedArm

        self._arm: Any = CorrectedArm(folder, step)
        self.step = float(self._arm.model.opt.timestep)

    def put(self, q: JointVector, v: JointVector) -> None:
        self._arm.put(q, v)

    def read(self) -> tuple[JointVector, JointVector]:
        return self._arm.read()

    def advance(self, torque: JointVector, seconds: float) -> None:
        for _ in range(steps_of(seconds, self.step)):
            self._arm.step(torque)

    def late_torque(self, joint: str) -> float:
        """Torque that the delayed read-out of a joint shows now [N m]."""
        return float(self._arm.data.sensor(f"{joint}_torque").data[0])


@final
class MujocoUrdfEngine(Engine):
    """model.urdf of an export, as MuJoCo reads it; torques act on the joints."""

    name = "mujoco"

    def __init__(self, folder: Path, joints: tuple[str, ...], step: float = 1e-3):
        mujoco = load_mujoco()
        spec = mujoco.MjSpec.from_file(str(folder / "model.urdf"))
        spec.option.timestep, spec.option.integrator = step, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        for name in joints:  # so that effort limits act
            actuator = spec.add_actuator(name=name, target=name)
            actuator.trntype = mujoco.mjtTrn.mjTRN_JOINT
        self._model = spec.compile()
        self._data, self._mujoco, self.step = mujoco.MjData(self._model), mujoco, step
        ids = [self._model.joint(n).id for n in joints]
        self._at, self._dof = self._model.jnt_qposadr[ids], self._model.jnt_dofadr[ids]

    def put(self, q: JointVector, v: JointVector) -> None:
        self._mujoco.mj_resetData(self._model, self._data)
        self._data.qpos[self._at], self._data.qvel[self._dof] = q, v
        self._mujoco.mj_forward(self._model, self._data)

    def read(self) -> tuple[JointVector, JointVector]:
        return self._data.qpos[self._at].copy(), self._data.qvel[self._dof].copy()

    def advance(self, torque: JointVector, seconds: float) -> None:
        self._data.ctrl[:] = np.asarray(torque, dtype=float)
        for _ in range(steps_of(seconds, self.step)):
            self._mujoco.mj_step(self._model, self._data)
