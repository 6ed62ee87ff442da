"""Recorded commands through a servo-driven model in an engine, rolled out from each first sample by commands alone."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path

import numpy as np

from lagnet.errors import LagnetError
from lagnet.models.corrected.servo_driven import ServoDrivenModel
from lagnet.recordings.recording import Recording
from lagnet.simulators.corrected_arm.servo_arm import servo_arm
from lagnet.simulators.engines.engine import Engine
from lagnet.simulators.engines.registry import FORMAT
from lagnet.simulators.engines.servo_engines import servo_engine
from lagnet.simulators.recorded_drive import RecordedDrive, commanded_stretches
from lagnet.simulators.replay import LONGEST_STEP, Replay, Replayed, ReplaySettings, checked_engine, stayed
from lagnet.simulators.servo_exporters.registry import SERVO_EXPORTERS
from lagnet.types import Trajectory

Roller = Callable[[RecordedDrive], Trajectory]
RollerOf = Callable[[ServoDrivenModel], AbstractContextManager[Roller]]


def replay_servos(model: ServoDrivenModel, recordings: list[Recording], settings: ReplaySettings) -> Replay:
    """Run recorded commands through the model in an engine.

    Raises:
        LagnetError: an unknown engine, other joints, recordings without commands, or another number of gains.
        MissingExtraError: the engine is not installed.
    """
    checked_engine(settings)
    step = min(LONGEST_STEP, 1.0 / settings.rate)

    @contextmanager
    def roller(model: ServoDrivenModel) -> Iterator[Roller]:
        with tempfile.TemporaryDirectory() as folder:
            SERVO_EXPORTERS[FORMAT[settings.engine]].write(servo_arm(model), Path(folder))
            with servo_engine(settings.engine, Path(folder), step) as engine:
                yield lambda drive: _rolled(engine, drive)

    return _replayed(model, recordings, settings, settings.engine, roller)


def replay_servos_reference(model: ServoDrivenModel, recordings: list[Recording], settings: ReplaySettings) -> Replay:
    """The same by the model's own rollouts."""

    def roller(model: ServoDrivenModel) -> AbstractContextManager[Roller]:
        return nullcontext(lambda drive: model.rollout(drive.target, drive.time, drive.q[0]))

    return _replayed(model, recordings, settings, "rollouts of the corrected model", roller)


def _replayed(
    model: ServoDrivenModel, recordings: list[Recording], settings: ReplaySettings, name: str, roller_of: RollerOf
) -> Replay:
    """Recordings of one gain after those of another, told in their order."""
    if settings.servo is not None:
        what = "the model holds the gains of its servos"
        raise LagnetError(what, where="--kp, --kd", next_step="leave them out, or replay its robot alone")
    drives = [_stretches(r, model, settings) for r in recordings]
    if not any(drives):
        raise LagnetError("no recording is long enough to replay", next_step="give at least a second of motion")
    gains, runs = _gains_of(recordings, settings), {}
    for gain in dict.fromkeys(gains):
        with roller_of(model if gain == 1.0 else model.at_gain(gain)) as roller:
            for i in (i for i, own in enumerate(gains) if own == gain):
                runs[i] = [Replayed(d.recording, d.time, d.q, roller(d), True) for d in drives[i]]
    told = tuple(run for i in range(len(recordings)) for run in runs[i])
    horizon = stayed([(r.q - r.q_measured, r.time[1] - r.time[0]) for r in told], settings.tolerance)
    return Replay(name, model.joints, told, horizon if settings.starts else None, settings)


def _gains_of(recordings: list[Recording], settings: ReplaySettings) -> list[float]:
    gains = list(settings.gains) or [1.0] * len(recordings)
    if len(gains) != len(recordings) or not all(np.isfinite(g) and g > 0.0 for g in gains):
        what = f"{', '.join(f'{g:g}' for g in gains)} for {len(recordings)} recordings"
        raise LagnetError(what, where="--gains", next_step="give a gain above zero for each, in their order")
    return gains


def _stretches(recording: Recording, model: ServoDrivenModel, settings: ReplaySettings) -> list[RecordedDrive]:
    where = recording.path or None
    if tuple(recording.joints) != tuple(model.joints):
        theirs = f"has the joints {', '.join(recording.joints)}, the model {', '.join(model.joints)}"
        raise LagnetError(theirs, where=where, next_step="give the recording's own robot")
    if recording.command is None:
        raise LagnetError("holds no commands, which drive this model", where=where, next_step="record command_i")
    none = np.zeros(model.n_dof)
    return commanded_stretches(recording, np.asarray(recording.command), settings, (none, none))


def _rolled(engine: Engine, drive: RecordedDrive) -> Trajectory:
    """Positions from the first sample on, at rest there, shape (n, dof)."""
    q = np.empty_like(drive.q)
    engine.put(drive.q[0], np.zeros(drive.q.shape[1]))
    for k in range(drive.time.size):
        q[k], _ = engine.read()
        engine.advance(drive.target[k], drive.step)
    return q
