"""What a log is, told before anything is done with it: format, joints, signals, clock, gaps, and what is odd."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.errors import RecordingError
from lagnet.recordings.inspection.guess_columns import guess_columns
from lagnet.recordings.loading.clock import GAP
from lagnet.recordings.loading.column_map import ColumnMap
from lagnet.recordings.loading.joint_match import JointMatch, match_joints
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.loading.opening import Progress, open_source, origin_of
from lagnet.recordings.readers.logs.log_source import Origin
from lagnet.recordings.recording import Recording
from lagnet.recordings.signals import UNITS


@dataclass(frozen=True)
class Signal:
    """One signal of all joints: its name, unit, and least and largest number."""

    kind: str
    unit: str
    least: float
    largest: float


@dataclass(frozen=True, eq=False)
class Description:
    """What was found in a log.

    Args:
        path: the file or folder.
        origin: what it was recognised as, and by what.
        joints: names that the log gives its joints, or that follow from its columns.
        match: where the robot's joints stand among them; None without a robot, or where the log names none.
        columns: the file's own columns.
        guessed: our columns to the file's, where its names are foreign; for the mapping file.
        recording: what was read, None where it was refused.
        refused: why it was refused, "" where it was not.
        signals: what was read.
        jitter: 5th and 95th percentile of the steps over the median step.
        gaps: (start [s], length [s]) of the longest gaps.
    """

    path: str
    origin: Origin
    joints: tuple[str, ...]
    match: JointMatch | None
    columns: tuple[str, ...]
    guessed: dict[str, str]
    recording: Recording | None
    refused: str
    signals: tuple[Signal, ...] = ()
    jitter: tuple[float, float] = (1.0, 1.0)
    gaps: tuple[tuple[float, float], ...] = ()


def describe(
    path: str | Path, robot: Any = None, columns: str | Path | None = None, progress: Progress | None = None
) -> Description:
    """Look at a log; what cannot be read as a recording is described all the same.

    Args:
        path: file or folder.
        robot: the robot that it may be of.
        columns: a mapping file to read it by.
        progress: told while a long log is read.

    Raises:
        RecordingError: not a log of any known kind, or damaged.
    """
    source, _ = open_source(path, progress)
    origin, names = origin_of(source, path), source.names
    guessed = {} if columns else guess_columns(names)
    recording, refused = _read(path, robot, columns, guessed)
    joints = source.joints or (recording.joints if recording is not None else ())
    match = match_joints(source.joints, robot.joints) if robot is not None and source.joints else None
    found = Description(str(path), origin, tuple(joints), match, names, guessed, recording, refused)
    return found if recording is None else replace(found, **_measured(recording))


def _read(
    path: str | Path, robot: Any, columns: str | Path | None, guessed: dict[str, str]
) -> tuple[Recording | None, str]:
    """The recording, and why it was refused as it stands: what is told of it then comes from a guess."""
    refused = ""
    guess = ColumnMap(guessed) if guessed else None
    by = columns or guess
    for mapping, constant, arm in ((columns, None, robot), (by, 1.0, robot), (by, 1.0, None)):
        try:
            return load_recording(path, columns=mapping, torque_constant=constant, robot=arm), refused
        except RecordingError as error:
            refused = refused or str(error)
    return None, refused


def _measured(recording: Recording) -> dict[str, Any]:
    signals = []
    for kind in recording.signals:
        values = getattr(recording, kind)
        signals.append(Signal(kind, UNITS[kind], float(values.min()), float(values.max())))
    inside = np.flatnonzero(np.diff(recording.trajectory) == 0)
    steps = np.diff(recording.time)[inside]
    if not steps.size:
        return {"signals": tuple(signals)}
    median = float(np.median(steps))
    long = inside[steps > GAP * median]
    lengths = np.diff(recording.time)[long]
    gaps = [(float(recording.time[long[k]]), float(lengths[k])) for k in np.argsort(-lengths)[:5]]
    low, high = np.percentile(steps, [5, 95]) / median
    return {"signals": tuple(signals), "jitter": (float(low), float(high)), "gaps": tuple(gaps)}
