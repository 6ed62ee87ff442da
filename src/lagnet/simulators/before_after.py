"""The user's own simulator before and after: nominal and corrected model in one engine, on the same recordings."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from lagnet.models.corrected.model import CorrectedModel
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import Robot
from lagnet.rigid_body.writing import write_text
from lagnet.simulators.replay import Replay, ReplaySettings, bare_robot, replay, replay_reference

JSON, TABLE = "replay.json", "replay.parquet"
SCHEMA = "lagnet-replay/1"
CHECKED = 10.0  # [s] of each recording over which engine and corrected model are compared


@dataclass(frozen=True, eq=False)
class BeforeAfter:
    """Replays of the same recordings.

    Args:
        before: the nominal model.
        after: the corrected one; None where only a nominal model was given.
    """

    before: Replay
    after: Replay | None

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
    return out


def before_and_after(
    model: Robot | CorrectedModel, recordings: list[Recording], settings: ReplaySettings
) -> BeforeAfter:
    """Replay recordings through a corrected model and the robot under it; a robot alone has no after.

    Raises:
        LagnetError: what `replay` raises.
    """
    nominal = bare_robot(model)
    before = replay(nominal, recordings, settings)
    return BeforeAfter(before, None if model is nominal else replay(model, recordings, settings))


def verify(model: Robot | CorrectedModel, recordings: list[Recording], settings: ReplaySettings) -> dict[str, Any]:
    """What `export --verify` states: engine against corrected model, and against reality before and after."""
    compared = before_and_after(model, recordings, settings)
    short = replace(settings, longest=min(settings.longest, CHECKED), starts=0)
    engine, reference = replay(model, recordings, short), replay_reference(model, recordings, short)
    gap = [a.q - b.q for a, b in zip(engine.runs, reference.runs, strict=True)]
    error = np.sqrt(np.mean(np.concatenate(gap) ** 2, axis=0))
    return compared.to_json() | {"engine_against_corrected_rmse": [float(x) for x in error]}


def write_replay(result: BeforeAfter, folder: str | Path) -> tuple[Path, Path]:
    """Writes `replay.json` and `replay.parquet`: recording, time, q_measured_i, q_before_i, q_after_i."""
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    write_text(out / JSON, json.dumps(result.to_json(), indent=1, allow_nan=False) + "\n")
    columns: dict[str, Any] = {
        "recording": np.concatenate([[r.recording] * len(r.time) for r in result.before.runs]),
        "time": np.concatenate([r.time for r in result.before.runs]),
    }
    signals: Mapping[str, Any] = {
        "q_measured": [r.q_measured for r in result.before.runs],
        "q_before": [r.q for r in result.before.runs],
        **({} if result.after is None else {"q_after": [r.q for r in result.after.runs]}),
    }
    for name, runs in signals.items():
        values = np.concatenate(runs)
        columns |= {f"{name}_{i}": values[:, i] for i in range(values.shape[1])}
    pq.write_table(pa.table(columns), out / TABLE)
    return out / JSON, out / TABLE
