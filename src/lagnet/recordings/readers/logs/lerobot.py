"""LeRobot data sets (v2.0, v2.1, v3.0): a folder with meta/info.json and Parquet files; an episode is a motion.

Source: LeRobot, data set format.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from lagnet.errors import RecordingError
from lagnet.recordings.readers.logs.log_source import LogSource, Origin, per_joint
from lagnet.recordings.readers.source import refuse_if_huge

INFO = Path("meta") / "info.json"
STATE, ACTION = "observation.state", "action"
SLOWEST, FASTEST = 1e-3, 1e6  # [Hz] of cameras and robots
EXACT = 2.0**53  # beyond which counters are no whole numbers any more
COUNTED = ("timestamp", "frame_index", "episode_index")
FEATURES = {
    "v": ("observation.velocity", "observation.velocities", "observation.qvel"),
    "tau": ("observation.effort", "observation.efforts", "observation.torque", "observation.torques"),
    "current": ("observation.current", "observation.currents"),
}
ENDINGS = {
    "pos": "q",
    "position": "q",
    "vel": "v",
    "velocity": "v",
    "effort": "tau",
    "torque": "tau",
    "tau": "tau",
    "current": "current",
}
VERSIONS = ("v2.0", "v2.1", "v3.0")
MAX_INFO = 16 * 1024**2
MADE = 1e-4  # [s] a stamp that near to frame / fps was made from it (stamps are of single precision)
NORMALISED = 101.0  # the largest number of a scale from -100 to 100 that overshoots a little


def is_lerobot_folder(path: Path) -> bool:
    """Whether a folder is a LeRobot data set."""
    return (path / INFO).is_file() and (path / "data").is_dir()


def open_lerobot(path: Path, where: str) -> LogSource:
    """Read joint positions and commands of all episodes.

    Raises:
        RecordingError: an unknown version, damaged files, or no joint positions.
    """
    info = _info(path, where)
    features = info.get("features")
    if not isinstance(features, dict) or STATE not in features:
        raise RecordingError(f"has no feature {STATE}", where=where, next_step="give a data set of joint positions")
    table = _table(path, features, where)
    kinds = _signals(table, features, where)
    joints, values = kinds
    stamps, frames, episodes = (table[n] for n in COUNTED)
    time, told, recorded = _clock(stamps, frames, info.get("fps"))
    columns = {"time": time}
    for kind, array in values.items():
        columns |= per_joint(kind, array)
    told += _scale(values["q"])
    version = str(info.get("codebase_version"))
    clock = "timestamps of the data set" if recorded else "made from frame numbers and fps"
    effort = next((n for n in FEATURES["tau"] if n in features), STATE) if "tau" in values else ""
    origin = Origin(f"LeRobot data set {version}", f"its {INFO.as_posix()}", clock, recorded, effort)
    return LogSource(origin, columns, joints, where, episodes.astype(np.int64), told)


def _info(path: Path, where: str) -> dict[str, Any]:
    try:
        file = path / INFO
        if file.stat().st_size > MAX_INFO:
            raise ValueError("too long")
        info = json.loads(file.read_bytes())
    except (OSError, ValueError, RecursionError) as error:
        raise RecordingError(f"{INFO.as_posix()} cannot be read ({str(error)[:80]})", where=where) from None
    version = info.get("codebase_version") if isinstance(info, dict) else None
    if version not in VERSIONS:
        raise RecordingError(f"is of version {version!r}", where=where, choices=VERSIONS)
    return info


def data_files(path: Path) -> list[Path]:
    """The Parquet files of a data set, in order."""
    return sorted((path / "data").glob("*/*.parquet"))


def _table(path: Path, features: dict[str, Any], where: str) -> dict[str, np.ndarray]:
    """The wanted columns of all files, sorted by episode and frame."""
    files = data_files(path)
    if not files:
        raise RecordingError("has no file data/*/*.parquet", where=where, next_step="download the data of the set")
    known = [name for names in FEATURES.values() for name in names if name in features]
    wanted = [*COUNTED, STATE, *([ACTION] if ACTION in features else []), *known]
    parts = []
    for file in files:
        try:
            opened = pq.ParquetFile(file)
            have = [name for name in wanted if name in opened.schema_arrow.names]
            missing = [name for name in wanted[:4] if name not in have]
            if missing:
                raise RecordingError(f"has no column {missing[0]}", where=str(file))
            refuse_if_huge(opened.metadata.num_rows * 8 * 64 * len(have) // 4, where)
            part = opened.read(columns=have, use_threads=False)
            arrays = {name: _array(part.column(name), name, str(file)) for name in have}
            parts.append({name: _shaped(values, name, str(file)) for name, values in arrays.items()})
        except (pa.ArrowException, OSError, UnicodeDecodeError) as error:
            said = (str(error).splitlines() or [""])[0][:100]
            raise RecordingError(f"is damaged ({said})", where=str(file), next_step="download it again") from None
    common = set.intersection(*(set(part) for part in parts))
    widths = {name: {part[name].shape[1:] for part in parts} for name in common}
    for name, found in widths.items():
        if len(found) > 1:
            raise RecordingError(f"{name} has different numbers of joints in its files", where=where)
    table = {name: np.concatenate([part[name] for part in parts]) for name in wanted if name in common}
    if not len(table[STATE]):
        raise RecordingError("holds no samples", where=where, next_step="download the data of the set")
    order = np.lexsort((table["frame_index"], table["episode_index"]))
    return {name: values[order] for name, values in table.items()}


def _shaped(values: np.ndarray, name: str, where: str) -> np.ndarray:
    """One finite number a row for time and counters; shape (n, k) for features, which hold one number where k is 1."""
    if name not in COUNTED:
        return values[:, None] if values.ndim == 1 else values
    if values.ndim != 1 or not (np.abs(values) < EXACT).all():
        raise RecordingError(f"{name} does not hold one number a row", where=where, next_step="download it again")
    return values


def _array(column: pa.ChunkedArray, name: str, where: str) -> np.ndarray:
    """Shape (n,) of numbers, or (n, k) of lists."""
    n, kind = len(column), column.type
    if pa.types.is_list(kind) or pa.types.is_large_list(kind) or pa.types.is_fixed_size_list(kind):
        chunks = [chunk.flatten() for chunk in column.chunks]
        flat = pa.chunked_array(chunks, type=kind.value_type).cast(pa.float64()).to_numpy()
        if not n or flat.size % n or column.null_count:
            raise RecordingError(f"{name} has rows of different lengths", where=where)
        if not pa.types.is_fixed_size_list(kind):
            lengths = {len(row) for chunk in column.chunks for row in chunk}
            if len(lengths) > 1:
                raise RecordingError(f"{name} has rows of different lengths", where=where)
        return flat.reshape(n, -1)
    return column.cast(pa.float64(), safe=False).to_numpy()


def _names(feature: Any, width: int) -> tuple[str, ...] | None:
    """Names of a feature: a list, a list in a list, or a list under a key such as `motors`; None without them."""
    names = feature.get("names") if isinstance(feature, dict) else None
    if isinstance(names, dict):
        names = next((n for n in names.values() if isinstance(n, list)), None)
    if isinstance(names, list) and len(names) == 1 and isinstance(names[0], list):
        names = names[0]
    if not isinstance(names, list) or len(names) != width or len(set(map(str, names))) != width:
        return None
    return tuple(map(str, names))


def _split(name: str) -> tuple[str, str]:
    """Joint and kind: `elbow.pos` is a position, a bare name too."""
    joint, _, ending = name.rpartition(".")
    return (joint, ENDINGS[ending]) if joint and ending in ENDINGS else (name, "q")


def _signals(
    table: dict[str, np.ndarray], features: dict[str, Any], where: str
) -> tuple[tuple[str, ...] | None, dict[str, np.ndarray]]:
    """Joint names, and per kind the values of shape (n, dof) in their order."""
    state = table[STATE]
    names = _names(features[STATE], state.shape[1])
    parted = [_split(name) for name in names or [f"joint_{k}" for k in range(state.shape[1])]]
    joints = tuple(joint for joint, kind in parted if kind == "q")
    if not joints:
        raise RecordingError(f"{STATE} names no joint positions ({parted[0][0]}, …)", where=where)
    values = {"q": state[:, [k for k, (_, kind) in enumerate(parted) if kind == "q"]]}
    for kind in ("v", "tau", "current"):
        found = _pick(state, parted, kind, joints)
        if found is None:
            name = next((n for n in FEATURES[kind] if n in table), None)
            found = (
                None if name is None else _aligned(table[name], _names(features[name], table[name].shape[1]), joints)
            )
        if found is not None:
            values[kind] = found
    if ACTION in table:
        told = _names(features[ACTION], table[ACTION].shape[1])
        command = _aligned(table[ACTION], told, joints)
        if command is not None:
            values["command"] = command
    return (joints if names else None), values


def _pick(state: np.ndarray, parted: list[tuple[str, str]], kind: str, joints: Sequence[str]) -> np.ndarray | None:
    at = {joint: k for k, (joint, found) in enumerate(parted) if found == kind}
    return state[:, [at[joint] for joint in joints]] if all(joint in at for joint in joints) else None


def _aligned(values: np.ndarray, names: tuple[str, ...] | None, joints: Sequence[str]) -> np.ndarray | None:
    """Columns in the order of the joints: by name, else as they come where there are as many."""
    if names is not None:
        at = {_split(name)[0].removeprefix("main_"): k for k, name in enumerate(names)}
        if all(joint.removeprefix("main_") in at for joint in joints):
            return values[:, [at[joint.removeprefix("main_")] for joint in joints]]
    return values if values.shape[1] == len(joints) else None


def _clock(stamps: np.ndarray, frames: np.ndarray, fps: Any) -> tuple[np.ndarray, tuple[str, ...], bool]:
    """Time [s], what to tell of it, and whether it was recorded."""
    if not isinstance(fps, (int, float)) or not SLOWEST <= fps <= FASTEST:
        return stamps, (), True
    made = frames / fps
    if np.max(np.abs(stamps - made)) > MADE + 1e-6 * np.max(np.abs(stamps)):
        return stamps, (), True
    text = (
        f"the clock is made from frame numbers ({fps:g} per second), not recorded: no delay below a frame can be told"
    )
    return made, (text,), False


def _scale(q: np.ndarray) -> tuple[str, ...]:
    """What to tell of numbers that are no radians."""
    largest = np.nanmax(np.abs(q), axis=0)
    if np.median(largest) <= 4 * np.pi:
        return ()
    if largest.max() <= NORMALISED:
        return (
            "positions run from -100 to 100 or in degrees: state the scale (and offset) of each joint with --columns",
        )
    return ("positions look like degrees: state [scale] q = 0.0174533 and command = 0.0174533 with --columns",)
