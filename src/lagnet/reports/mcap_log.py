"""A diagnosis as an MCAP file that Foxglove, PlotJuggler and Rerun open: torques as JointState, the verdict as a log.

Topics `/measured`, `/nominal`, `/corrected` and `/residual` (measured less corrected) are sensor_msgs/JointState with
the torque as effort; `/verdict` is rcl_interfaces/Log; the whole verdict.json is attached. Recordings whose clocks
start anew are laid one after the other.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.errors import MissingExtraError
from lagnet.types import Samples, Trajectory

TOPICS = ("measured", "nominal", "corrected", "residual")
PAUSE = 1.0  # [s] between recordings
INFO, WARN = 20, 30  # levels of rcl_interfaces/Log
STAMP = "int32 sec\nuint32 nanosec"
JOINT_STATE = (
    "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n"
    f"{'=' * 80}\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
    f"{'=' * 80}\nMSG: builtin_interfaces/Time\n{STAMP}"
)
LOG = (
    "builtin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\nstring file\nstring function\nuint32 line\n"
    f"{'=' * 80}\nMSG: builtin_interfaces/Time\n{STAMP}"
)


@dataclass(frozen=True, eq=False)
class TorqueLog:
    """One recording.

    Args:
        time: shape (n,), [s].
        q, v: shape (n, dof), [rad, rad/s].
        torques: `measured`, `nominal` and `corrected`, each of shape (n, dof) [N m].
    """

    time: Samples
    q: Trajectory
    v: Trajectory
    torques: Mapping[str, Trajectory]


def write_mcap(path: str | Path, joints: Sequence[str], logs: Sequence[TorqueLog], verdict: Mapping[str, Any]) -> Path:
    """Write the file in one step.

    Args:
        path: the file; replaced.
        joints: names in model order.
        logs: held-out recordings.
        verdict: what verdict.json holds.

    Raises:
        MissingExtraError: the packages that write MCAP are not installed.
    """
    try:
        from mcap_ros2.writer import Writer  # pyright: ignore[reportMissingImports]
    except ImportError:
        raise MissingExtraError("writing MCAP needs a package", next_step="pip install 'lagnet[mcap]'") from None
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    draft = path.with_name(path.name + ".partial")
    try:
        with draft.open("wb") as file:
            writer = Writer(file)
            state = writer.register_msgdef("sensor_msgs/msg/JointState", JOINT_STATE)
            log = writer.register_msgdef("rcl_interfaces/msg/Log", LOG)
            for n, (level, words) in enumerate(verdict_lines(verdict)):
                message = {"stamp": _stamp(0), "level": level, "name": "lagnet", "msg": words, "line": n}
                writer.write_message("/verdict", log, message | {"file": "", "function": ""}, log_time=n, sequence=n)
            for topic, at, message in _states(joints, logs):
                writer.write_message(f"/{topic}", state, message, log_time=at)
            text = json.dumps(verdict, allow_nan=False).encode()
            writer.add_attachment(0, 0, "verdict.json", "application/json", text)
            writer.finish()
        os.replace(draft, path)
    finally:
        draft.unlink(missing_ok=True)
    return path


def verdict_lines(verdict: Mapping[str, Any]) -> list[tuple[int, str]]:
    """Level and words of what the log channel says."""
    lines = [(INFO, str(effect["explanation"])) for effect in verdict["effects"]]
    if not lines:
        found = verdict["mismatch"]["found"]
        lines = [(INFO, "The mismatch found fits no known physics." if found else "No left-out physics was found.")]
    return lines + [(WARN, str(words)) for words in verdict["warnings"]]


def _states(joints: Sequence[str], logs: Sequence[TorqueLog]) -> Iterator[tuple[str, int, dict[str, Any]]]:
    """Topic, time [ns] and message of every sample, in the order of time."""
    start = 0.0
    for log in logs:
        torques = {**log.torques, "residual": log.torques["measured"] - log.torques["corrected"]}
        for k, t in enumerate(log.time - log.time[0] + start):
            at = round(float(t) * 1e9)
            header = {"stamp": _stamp(at), "frame_id": ""}
            motion = {"name": list(joints), "position": log.q[k].tolist(), "velocity": log.v[k].tolist()}
            for topic in TOPICS:
                yield topic, at, {"header": header, **motion, "effort": torques[topic][k].tolist()}
        start += float(log.time[-1] - log.time[0]) + PAUSE


def _stamp(nanoseconds: int) -> dict[str, int]:
    return {"sec": nanoseconds // 10**9, "nanosec": nanoseconds % 10**9}


def logs_of(table: Mapping[str, Any], motions: Sequence[tuple[Trajectory, Trajectory]], n_dof: int) -> list[TorqueLog]:
    """Held-out recordings of `holdout_torque.parquet` (columns by name) with their positions and speeds.

    Args:
        table: the columns.
        motions: q and v of every held-out recording in the order of the file, each of shape (n, dof).
        n_dof: number of joints.
    """
    logs, start = [], 0
    for q, v in motions:
        rows = slice(start, start + len(q))
        torques = {
            kind: np.column_stack([np.asarray(table[f"tau_{kind}_{j}"], dtype=float)[rows] for j in range(n_dof)])
            for kind in ("measured", "nominal", "corrected")
        }
        logs.append(TorqueLog(np.asarray(table["time"], dtype=float)[rows], q, v, torques))
        start += len(q)
    return logs
