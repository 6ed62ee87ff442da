"""Writes recordings in the formats that `load_recording` reads: no digit lost, the same bytes every time."""

from __future__ import annotations

import gzip
import io
import json
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq

from lagnet.errors import RecordingError
from lagnet.files import write_whole
from lagnet.recordings.readers.parquet_file import JOINTS_KEY
from lagnet.recordings.recording import Recording

EPOCH = (1980, 1, 1, 0, 0, 0)  # the oldest date of a zip archive: bytes must not depend on the day


def write_recording(recording: Recording, path: str | Path) -> Path:
    """Store a recording; a reader gets every number back bit for bit.

    Args:
        recording: what to store; absent signals stay absent.
        path: .csv, .csv.gz, .parquet or .npz file; replaced in one step, so that no half-written file is ever seen.

    Returns:
        The path written.

    Raises:
        RecordingError: unknown suffix.
    """
    path = Path(path)
    suffix = next((s for s in sorted(WRITERS, key=len, reverse=True) if path.name.lower().endswith(s)), None)
    if suffix is None:
        raise RecordingError(f"cannot write the format {path.suffix!r}", where=str(path), choices=WRITERS)
    content = WRITERS[suffix](recording)
    write_whole(path, content)
    return path


def recording_table(recording: Recording) -> pa.Table:
    """The recording as a table with the columns of the recording contract."""
    columns: dict[str, np.ndarray] = {"time": recording.time}
    for kind in recording.signals:
        values = getattr(recording, kind)
        columns |= {f"{kind}_{i}": values[:, i] for i in range(recording.n_dof)}
    if _labelled(recording):
        columns["trajectory"] = _labels(recording)
    return pa.table(columns)


def _labelled(recording: Recording) -> bool:
    return recording.trajectory_names != ("0",)


def _labels(recording: Recording) -> np.ndarray:
    return np.asarray(recording.trajectory_names, dtype=str)[recording.trajectory]


def _csv(recording: Recording) -> bytes:
    # Arrow writes the shortest text that reads back to the same float64.
    stream = io.BytesIO()
    pa_csv.write_csv(recording_table(recording), stream, pa_csv.WriteOptions(quoting_header="none"))
    return stream.getvalue()


def _csv_gz(recording: Recording) -> bytes:
    return gzip.compress(_csv(recording), compresslevel=3, mtime=0)


def _parquet(recording: Recording) -> bytes:
    stream = io.BytesIO()
    table = recording_table(recording).replace_schema_metadata({JOINTS_KEY: json.dumps(list(recording.joints))})
    pq.write_table(table, stream, compression="zstd")
    return stream.getvalue()


def _npz(recording: Recording) -> bytes:
    arrays = {name: getattr(recording, name) for name in ("time", *recording.signals)}
    arrays |= {"joints": np.asarray(recording.joints, dtype=str)}
    if _labelled(recording):
        arrays["trajectory"] = _labels(recording)
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, values in arrays.items():
            content = io.BytesIO()
            np.lib.format.write_array(content, values, allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy", EPOCH), content.getvalue(), zipfile.ZIP_DEFLATED)
    return stream.getvalue()


WRITERS: dict[str, Callable[[Recording], bytes]] = {
    ".csv": _csv,
    ".csv.gz": _csv_gz,
    ".parquet": _parquet,
    ".npz": _npz,
}
