"""Recorded commands or torques through a model in an engine, against what was measured.

Three replays. *Held*: the recorded torque, with soft feedback to the recorded motion, so that the whole recording can
be laid over the simulation; what the model lacks shows as a deviation that the feedback balances. *Free*: the recorded
torque alone, from measured positions and speeds at many starts, for as long as it stays near: the horizon. *Commanded*:
where the recording holds commands and the servo's gains are given, rolled out from the first sample alone; its horizon
is the time for which such a rollout stays near.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.errors import LagnetError
from lagnet.models.corrected.model import CorrectedModel
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import Robot
from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics, arm_physics
from lagnet.simulators.corrected_arm.driven_arm import DrivenArm
from lagnet.simulators.engines.engine import Engine
from lagnet.simulators.engines.registry import ENGINES, FORMAT, engine_of
from lagnet.simulators.recorded_drive import RecordedDrive, recorded_drives
from lagnet.simulators.registry import exporter_named
from lagnet.types import JointVector, Samples, Trajectory

LONGEST_STEP = 1e-3  # [s] of an engine


@dataclass(frozen=True)
class Servo:
    """A position controller: τ = kp (command − q) − kd v, or kd (command velocity − v) where that is recorded.

    Args:
        kp, kd: shape (dof,), [N m/rad], [N m s/rad].
    """

    kp: tuple[float, ...]
    kd: tuple[float, ...]


@dataclass(frozen=True)
class ReplaySettings:
    """How recordings are replayed.

    Args:
        engine: a name of `ENGINES`.
        rate: of the controller, which recorded signals are brought to [Hz].
        bandwidth: of the feedback of held replays [rad/s].
        tolerance: error of any joint at which a free rollout has left the recording [rad or m].
        window: longest free rollout of recorded torques [s].
        starts: free rollouts of recorded torques, spread over all recordings; 0: no horizon.
        longest: of each recording that is replayed [s].
        servo: gains of the position controller, for recordings of commands.
        gains: of servo-driven models, the controllers' gains in each recording over the model's; none: as they are.
    """

    engine: str = "mujoco"
    rate: float = 1000.0
    bandwidth: float = 8.0
    tolerance: float = 0.05
    window: float = 2.0
    starts: int = 20
    longest: float = 30.0
    servo: Servo | None = None
    gains: tuple[float, ...] = ()


@dataclass(frozen=True, eq=False)
class Replayed:
    """One stretch of one recording in an engine.

    Args:
        recording: its file name.
        time: shape (n,), [s].
        q_measured, q: shape (n, dof), recorded and simulated positions [rad].
        commanded: whether commands drove it, else torques with feedback.
    """

    recording: str
    time: Samples
    q_measured: Trajectory
    q: Trajectory
    commanded: bool

    def rmse(self) -> JointVector:
        """Root mean square error, shape (dof,) [rad]."""
        return np.sqrt(np.mean((self.q - self.q_measured) ** 2, axis=0))


@dataclass(frozen=True, eq=False)
class Horizon:
    """How long rollouts without feedback to the recorded motion stayed near it.

    Args:
        seconds: shape (starts,), time for which a rollout stayed within the tolerance, or was followed.
        left: shape (starts,), whether it left the tolerance; else it was within when the window or stretch ended.
    """

    seconds: np.ndarray
    left: np.ndarray

    @property
    def median(self) -> float:
        """Median time within the tolerance [s]."""
        return float(np.median(self.seconds)) if self.seconds.size else float("nan")


@dataclass(frozen=True, eq=False)
class Replay:
    """A model in an engine against recordings."""

    engine: str
    joints: tuple[str, ...]
    runs: tuple[Replayed, ...]
    horizon: Horizon | None
    settings: ReplaySettings

    def rmse(self) -> JointVector:
        """Root mean square error over all runs, shape (dof,) [rad]."""
        count = np.array([len(r.time) for r in self.runs])
        return np.sqrt(np.average([r.rmse() ** 2 for r in self.runs], axis=0, weights=count))


Mover = Callable[[JointVector, JointVector], Any]
"""Makes an arm that moves, started at positions and speeds."""


def replay(model: Robot | CorrectedModel, recordings: list[Recording], settings: ReplaySettings) -> Replay:
    """Run recordings through a model in an engine.

    Raises:
        LagnetError: an unknown engine, other joints, commands without the servo's gains, or gains over those of a model
            without servos.
        MissingExtraError: the engine is not installed.
    """
    if settings.gains:
        what = "the model has no servos whose gains others could be relative to"
        raise LagnetError(what, where="--gains", next_step="give a folder of a diagnosis on motion, or --kp and --kd")
    with started(model, settings) as (arm, engine):
        return _replayed(arm, _driven_robot(model, arm), recordings, settings, settings.engine, _starter(engine))


def checked_engine(settings: ReplaySettings) -> None:
    """Raises LagnetError for an unknown engine."""
    if settings.engine not in ENGINES:
        raise LagnetError(f"unknown engine {settings.engine!r}", where="--engine", choices=ENGINES)


@contextmanager
def started(model: Robot | CorrectedModel, settings: ReplaySettings) -> Iterator[tuple[ArmPhysics, Engine]]:
    """A model's forward physics, and the engine that runs it, for as long as the context lasts.

    Raises:
        LagnetError: an unknown engine, or a model without bodies.
        MissingExtraError: the engine is not installed.
    """
    checked_engine(settings)
    arm, exporter = arm_physics(model), exporter_named(FORMAT[settings.engine])
    with tempfile.TemporaryDirectory() as folder:
        exporter.write(arm, Path(folder))
        step = min(LONGEST_STEP, 1.0 / settings.rate)
        with engine_of(exporter.name, settings.engine, Path(folder), arm.robot.joints, step) as engine:
            yield arm, engine


def replay_reference(model: Robot | CorrectedModel, recordings: list[Recording], settings: ReplaySettings) -> Replay:
    """The same replay by the corrected model's own forward motion, without free rollouts."""
    arm = arm_physics(model)
    step = 1.0 / settings.rate

    def mover(q: JointVector, v: JointVector) -> DrivenArm:
        return DrivenArm(arm, step, q, v)

    settings = replace(settings, starts=0)
    nominal = _driven_robot(model, arm)
    return _replayed(arm, nominal, recordings, settings, "forward dynamics of the corrected model", mover)


def bare_robot(model: Any) -> Robot:
    """The robot under all corrections."""
    return bare_robot(model.nominal) if isinstance(model, CorrectedModel) else model


def _driven_robot(model: Any, arm: ArmPhysics) -> Robot:
    """Whose inertia scales the feedback: the robot under all corrections, or the corrected one where that has none."""
    bare = bare_robot(model)
    return bare if bare.can_move else arm.robot


def _starter(engine: Engine) -> Mover:
    def mover(q: JointVector, v: JointVector) -> Engine:
        engine.put(q, v)
        return engine

    return mover


def _replayed(
    arm: ArmPhysics, nominal: Robot, recordings: list[Recording], settings: ReplaySettings, name: str, mover: Mover
) -> Replay:
    drives = [d for r in recordings for d in recorded_drives(r, nominal, arm, settings)]
    if not drives:
        raise LagnetError("no recording is long enough to replay", next_step="give at least a second of motion")
    runs = tuple(_run(drive, mover) for drive in drives)
    torques = [d for d in drives if not d.commanded]
    horizon = _horizon(torques, mover, settings) if torques and settings.starts else None
    if not torques and settings.starts:
        horizon = stayed([(r.q - r.q_measured, r.time[1] - r.time[0]) for r in runs], settings.tolerance)
    return Replay(name, arm.robot.joints, runs, horizon, settings)


def _run(drive: RecordedDrive, mover: Mover) -> Replayed:
    arm, q = mover(drive.q[0], drive.v[0]), np.empty_like(drive.q)
    step = drive.step
    for k in range(drive.time.size):
        q[k], v = arm.read()
        arm.advance(drive.torque(k, q[k], v), step)
    return Replayed(drive.recording, drive.time, drive.q, q, drive.commanded)


def _horizon(drives: list[RecordedDrive], mover: Mover, settings: ReplaySettings) -> Horizon:
    """Free rollouts from starts spread over all stretches."""
    most = round(settings.window * settings.rate)
    room = np.array([max(d.time.size - most, 1) for d in drives])
    at = np.linspace(0, room.sum() - 1, settings.starts).astype(int)
    edges = np.concatenate([[0], np.cumsum(room)])
    errors = []
    for start in at:
        i = int(np.searchsorted(edges, start, side="right") - 1)
        errors.append((_free(drives[i], int(start - edges[i]), most, mover, settings.tolerance), drives[i].step))
    return stayed(errors, settings.tolerance)


def stayed(errors: Sequence[tuple[Trajectory, float]], tolerance: float) -> Horizon:
    """The horizon of rollouts by their errors, shape (steps, dof), and periods [s]."""
    seconds, left = [], []
    for error, step in errors:
        outside = np.flatnonzero(np.any(~(np.abs(error) <= tolerance), axis=1))
        seconds.append((outside[0] if outside.size else len(error)) * step)
        left.append(outside.size > 0)
    return Horizon(np.array(seconds), np.array(left, dtype=bool))


def _free(drive: RecordedDrive, start: int, most: int, mover: Mover, tolerance: float) -> Trajectory:
    """Error of a rollout of recorded torques alone, shape (steps, dof); it ends far outside the tolerance."""
    arm, error = mover(drive.q[start], drive.v[start]), []
    for k in range(start, min(start + most, drive.time.size)):
        q, _ = arm.read()
        error.append(q - drive.q[k])
        if not np.all(np.abs(error[-1]) < 20.0 * tolerance):
            break
        arm.advance(drive.logged[k], drive.step)
    return np.nan_to_num(np.array(error), nan=1e3, posinf=1e3, neginf=-1e3)
