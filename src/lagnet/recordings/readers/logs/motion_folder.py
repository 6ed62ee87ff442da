"""Folders of one motion: control.csv and state_motor.csv with lists in their cells, microseconds, joint_list.txt."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import numpy as np

from lagnet.errors import RecordingError
from lagnet.recordings.readers.logs.log_source import LogSource, Origin, from_first_command, held, per_joint
from lagnet.recordings.readers.source import refuse_if_huge

CONTROL, STATE, JOINTS = "control.csv", "state_motor.csv", "joint_list.txt"
ORIGIN = Origin(
    "motion folder", f"the files {CONTROL} and {STATE}", f"timestamps of {STATE}, in microseconds", effort=""
)
MICRO = 1e6
MAX_BYTES = 256 * 1024**2
COLUMNS = {"positions": "q", "velocities": "v", "torques": "tau"}


def is_motion_folder(path: Path) -> bool:
    """Whether a folder holds the two files."""
    return (path / CONTROL).is_file() and (path / STATE).is_file()


def open_motion_folder(path: Path, where: str) -> LogSource:
    """Read commands and measurements of one motion.

    Raises:
        RecordingError: missing columns, or cells that are no lists of numbers.
    """
    time, state = _read(path / STATE, tuple(COLUMNS))
    told_time, told = _read(path / CONTROL, ("positions",))
    q = state["positions"]
    joints = _joints(path, q.shape[1], where)
    if told["positions"].shape[1] != q.shape[1]:
        raise RecordingError(f"{CONTROL} has {told['positions'].shape[1]} joints, {STATE} {q.shape[1]}", where=where)
    columns, warnings = {"time": (time - time[0]) / MICRO}, []
    for name, kind in COLUMNS.items():
        values = state.get(name)
        if values is None:
            continue
        if kind != "q" and _has_no_sign(values, time, q, kind):
            warnings.append(f"{name} are magnitudes without sign: they were not read as {_words(kind)}")
            columns |= per_joint(f"{name}_magnitude", values)
            continue
        columns |= per_joint(kind, values)
    order = np.argsort(told_time, kind="stable")
    columns |= per_joint("command", held(told_time[order], told["positions"][order], time))
    columns, _, cut = from_first_command(columns)
    origin = (
        ORIGIN
        if not any(n.startswith("tau_") for n in columns)
        else Origin(ORIGIN.format, ORIGIN.recognised_by, ORIGIN.clock, True, f"torques of {STATE}")
    )
    return LogSource(origin, columns, joints, where, warnings=(*warnings, *cut))


def _words(kind: str) -> str:
    return {"v": "velocity", "tau": "torque"}[kind]


def _has_no_sign(values: np.ndarray, time: np.ndarray, q: np.ndarray, kind: str) -> bool:
    """Whether a signal of joints that move both ways never gets negative."""
    there_and_back = (np.diff(q, axis=0) > 0).any(axis=0) & (np.diff(q, axis=0) < 0).any(axis=0)
    return bool(values.any() and there_and_back.any() and (values >= 0).all())


def _joints(path: Path, n_dof: int, where: str) -> tuple[str, ...] | None:
    for folder in (path, path.parent):
        file = folder / JOINTS
        if file.is_file() and file.stat().st_size < 64 * 1024:
            names = tuple(file.read_text(encoding="utf-8", errors="replace").split())
            if len(names) != n_dof or len(set(names)) != n_dof:
                raise RecordingError(
                    f"{file} names {len(names)} joints, {STATE} has {n_dof}", where=where, next_step="correct the list"
                )
            return names
    return None


def _read(file: Path, wanted: tuple[str, ...]) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Stamps of shape (n,) and per column of lists its numbers, shape (n, dof)."""
    refuse_if_huge(file.stat().st_size * (1 + (file.stat().st_size > MAX_BYTES) * 100), str(file))
    text = file.read_bytes().decode("utf-8-sig", errors="replace")
    rows = csv.reader(io.StringIO(text, newline=""), skipinitialspace=True)
    header = [cell.strip() for cell in next(rows, [])]
    if "timestamp" not in header or "positions" not in header:
        raise RecordingError(
            "has no columns timestamp and positions", where=str(file), next_step="the first line must name them"
        )
    at = {name: header.index(name) for name in wanted if name in header}
    stamps: list[float] = []
    found: dict[str, list[list[float]]] = {name: [] for name in at}
    lines = list(rows)
    while lines and len(lines[-1]) != len(header):
        lines.pop()  # a last line that was cut short
    for number, row in enumerate(lines, start=2):
        try:
            stamp = float(row[header.index("timestamp")])
            cells = {name: _numbers(row[k]) for name, k in at.items()}
        except (ValueError, IndexError, TypeError, RecursionError):
            raise RecordingError(
                f"line {number}: expected a timestamp and lists of numbers", where=str(file), next_step="correct it"
            ) from None
        stamps.append(stamp)
        for name, cell in cells.items():
            found[name].append(cell)
    arrays = {name: _matrix(cells, name, str(file)) for name, cells in found.items()}
    return np.array(stamps), arrays


def _numbers(cell: str) -> list[float]:
    values = json.loads(cell)
    if not isinstance(values, list) or not all(isinstance(v, (int, float)) for v in values):
        raise ValueError(cell)
    return values


def _matrix(cells: list[list[float]], name: str, where: str) -> np.ndarray:
    if not cells:
        raise RecordingError("holds no samples", where=where, next_step="record again or give another file")
    width = len(cells[0])
    wrong = next((k for k, cell in enumerate(cells) if len(cell) != width), None)
    if wrong is not None or not width:
        raise RecordingError(
            f"line {(wrong or 0) + 2}: {name} has {len(cells[wrong or 0])} numbers, the first line {width}", where=where
        )
    return np.array(cells, dtype=np.float64)
