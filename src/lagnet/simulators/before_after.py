"""The user's own simulator before and after: nominal and corrected model in one engine, on the same recordings."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from lagnet.errors import RobotError
from lagnet.files import write_whole
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.servo_driven import ServoDrivenModel
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.descriptions.writing import write_text
from lagnet.rigid_body.robot import Robot
from lagnet.simulators.corrected_arm.arm_physics import arm_physics
from lagnet.simulators.replay import Replay, ReplaySettings, bare_robot, replay, replay_reference
from lagnet.simulators.servo_replay import replay_servos, replay_servos_reference

JSON, TABLE = "replay.json", "replay.parquet"
SCHEMA = "lagnet-replay/1"
CHECKED = 10.0  # [s] of each recording over which engine and corrected model are compared
TABLE_RATE = 200.0  # [Hz] at most of the trajectories that are kept


@dataclass(frozen=True, eq=False)
class BeforeAfter:
    """Replays of the same recordings.

    Args:
        before: the nominal model; the corrected one where links without mass cannot be simulated.
        after: the corrected one; None where only one model can be replayed.
        units: of each joint's position: rad or m.
    """

    before: Replay
    after: Replay | None
    units: tuple[str, ...]

    @property
    def joints(self) -> tuple[str, ...]:
        """Joint names in model order."""
        return self.before.joints

    def to_json(self) -> dict[str, Any]:
        """Plain data: errors by joint, horizons, settings."""
        settings = self.before.settings
        out: dict[str, Any] = {
            "schema": SCHEMA,
            "engine": self.before.engine,
            "mode": "commands" if self.before.runs[0].commanded else "torques",
            "tolerance_rad": settings.tolerance,
            "window_s": settings.window,
            "bandwidth_rad_s": None if self.before.runs[0].commanded else settings.bandwidth,
            "joints": list(self.joints),
            "units": list(self.units),
            "recordings": [{"recording": r.recording, "seconds": _span(r.time)} for r in self.before.runs],
            "before": _figures(self.before),
            "after": None if self.after is None else _figures(self.after),
        }
        if self.after is not None:
            ratio = np.linalg.norm(self.after.rmse()) / max(float(np.linalg.norm(self.before.rmse())), 1e-300)
            out["error_ratio"] = float(ratio)
        return out


def _span(time: np.ndarray) -> float:
    return float(time[-1] - time[0])


def _figures(result: Replay) -> dict[str, Any]:
    out: dict[str, Any] = {"rmse": [float(x) for x in result.rmse()]}
    if result.horizon is not None:
        out["horizon_median_s"] = result.horizon.median
        out["horizons_s"] = [float(x) for x in result.horizon.seconds]
        out["horizons_left"] = [bool(x) for x in result.horizon.left]
    return out


def before_and_after(
    model: Robot | CorrectedModel | ServoDrivenModel,
    recordings: list[Recording],
    settings: ReplaySettings,
    nominal: Robot | CorrectedModel | None = None,
) -> BeforeAfter:
    """Replay recordings through a corrected model and the one before it; a robot alone has no after.

    Args:
        model: the corrected model, or a robot.
        recordings: of torques or commands.
        settings: how they are replayed.
        nominal: the model before; None: the robot under all corrections.

    Raises:
        LagnetError: what `replay` raises.
    """
    if isinstance(model, ServoDrivenModel):
        return _servos_before_and_after(model, recordings, settings)
    nominal = bare_robot(model) if nominal is None else nominal
    units, after = units_of(bare_robot(model)), None if model is nominal else replay(model, recordings, settings)
    if after is not None and not _can_move(nominal):
        return BeforeAfter(after, None, units)
    return BeforeAfter(replay(nominal, recordings, settings), after, units)


def _can_move(model: Robot | CorrectedModel) -> bool:
    """Whether torque moves a model: something behind each of its joints has mass."""
    try:
        arm_physics(model)
    except RobotError:
        return False
    return True


def _servos_before_and_after(
    model: ServoDrivenModel, recordings: list[Recording], settings: ReplaySettings
) -> BeforeAfter:
    """Before are the robot and servos that the diagnosis began with; a model that keeps none has no after."""
    units = units_of(model.nominal)
    now = replay_servos(model, recordings, settings)
    if model.before is None:
        return BeforeAfter(now, None, units)
    return BeforeAfter(replay_servos(model.before, recordings, settings), now, units)


def units_of(robot: Robot) -> tuple[str, ...]:
    """Units of positions, joint by joint."""
    return tuple("m" if t == "prismatic" else "rad" for t in robot.joint_types)


def verify(
    model: Robot | CorrectedModel | ServoDrivenModel, recordings: list[Recording], settings: ReplaySettings
) -> dict[str, Any]:
    """What `export --verify` states: engine against corrected model, and against reality before and after."""
    compared = before_and_after(model, recordings, settings)
    short = replace(settings, longest=min(settings.longest, CHECKED), starts=0)
    driven = isinstance(model, ServoDrivenModel)
    engine = replay_servos(model, recordings, short) if driven else replay(model, recordings, short)
    reference = (
        replay_servos_reference(model, recordings, short) if driven else replay_reference(model, recordings, short)
    )
    gap = [a.q - b.q for a, b in zip(engine.runs, reference.runs, strict=True)]
    error = np.sqrt(np.mean(np.concatenate(gap) ** 2, axis=0))
    return compared.to_json() | {"engine_against_corrected_rmse": [float(x) for x in error]}


def write_replay(result: BeforeAfter, folder: str | Path) -> tuple[Path, Path]:
    """Writes `replay.json` and `replay.parquet`, the latter with the columns of `columns_of`."""
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    write_text(out / JSON, json.dumps(result.to_json(), indent=1, allow_nan=False) + "\n")
    table = io.BytesIO()
    pq.write_table(pa.table(columns_of(result)), table, compression="zstd")
    write_whole(out / TABLE, table.getvalue())
    return out / JSON, out / TABLE


def columns_of(result: BeforeAfter) -> dict[str, np.ndarray]:
    """Trajectories at 200 Hz or less: recording, time, q_measured_i, q_before_i, q_after_i, each of shape (n,)."""
    every = [max(1, round(1.0 / (TABLE_RATE * (r.time[1] - r.time[0])))) for r in result.before.runs]
    times = [r.time[::k] for r, k in zip(result.before.runs, every, strict=True)]
    columns: dict[str, np.ndarray] = {
        "recording": np.concatenate([[r.recording] * t.size for r, t in zip(result.before.runs, times, strict=True)]),
        "time": np.concatenate(times),
    }
    signals: Mapping[str, Any] = {
        "q_measured": [r.q_measured for r in result.before.runs],
        "q_before": [r.q for r in result.before.runs],
        **({} if result.after is None else {"q_after": [r.q for r in result.after.runs]}),
    }
    for name, runs in signals.items():
        values = np.concatenate([q[::k] for q, k in zip(runs, every, strict=True)])
        columns |= {f"{name}_{i}": values[:, i] for i in range(values.shape[1])}
    return columns
