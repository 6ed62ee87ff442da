"""What tracking writes as Parquet: every parameter of every recording, changes, and where each robot stands.

Rows stand in the order of robot, date and parameter, so that the same inputs give the same bytes, however often the
command was interrupted and wherever its pieces were done.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Sequence
from dataclasses import dataclass, fields
from datetime import datetime
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.dataset as ds
import pyarrow.parquet as pq

from lagnet.tracking.growth import NotFollowed
from lagnet.tracking.statistics.analyse import Analysis, Event, Standing

PARTITIONED = 1_000_000  # rows from which track.parquet is a folder with a part for each robot
TRACK, CHANGES, FAMILY = "track.parquet", "changes.parquet", "family.parquet"
NOT_FOLLOWED = "not_followed.parquet"
MOMENT = pa.timestamp("us")


@dataclass(frozen=True)
class TrackRow:
    """A parameter in a recording, or one row without parameter for a recording that shows none or could not be read.

    Args:
        robot, make: whose it is.
        joint, effect, parameter, unit: what it is; joint None for the whole arm.
        value, lower, upper: with the 95 % interval.
        adjusted: value at the usual temperature and load of the make.
        outlier: whether it stands apart from the recordings before and after, and was left out of the tests.
        date: of the recording.
        temperature: of the joint, for the whole arm the mean of all [°C].
        load: mean magnitude of the torque that the bodies need at the joint [N m].
        recording: its path, seen from the manifest.
        diagnosis: folder of its diagnosis, seen from the output folder; None where the set explained all as usual.
        error: why there is no diagnosis.
    """

    robot: str
    make: str
    date: datetime
    recording: str
    diagnosis: str | None = None
    joint: str | None = None
    effect: str | None = None
    parameter: str | None = None
    unit: str | None = None
    value: float | None = None
    lower: float | None = None
    upper: float | None = None
    adjusted: float | None = None
    outlier: bool | None = None
    temperature: float | None = None
    load: float | None = None
    error: str | None = None


def write_tables(rows: Sequence[TrackRow], analysis: Analysis, not_followed: Sequence[NotFollowed], out: Path) -> None:
    """Writes track.parquet, changes.parquet, family.parquet and not_followed.parquet, each in one step."""
    ordered = sorted(
        rows, key=lambda r: (r.robot, r.date, r.recording, r.effect or "", r.joint or "", r.parameter or "")
    )
    table = _table(TrackRow, ordered)
    if len(ordered) > PARTITIONED:
        _replace_folder(table, out / TRACK)
    else:
        _replace_file(table, out / TRACK)
    _replace_file(_table(Event, analysis.events), out / CHANGES)
    _replace_file(_table(Standing, analysis.standings), out / FAMILY)
    _replace_file(_table(NotFollowed, not_followed), out / NOT_FOLLOWED)


def read_track(out: Path) -> pa.Table:
    """track.parquet, in one file or in parts."""
    return ds.dataset(out / TRACK, format="parquet", partitioning="hive").to_table()


def _table(kind: Any, rows: Sequence[Any]) -> pa.Table:
    types = {"str": pa.string(), "float": pa.float64(), "bool": pa.bool_(), "datetime": MOMENT, "int": pa.int64()}
    schema = pa.schema([(f.name, types[str(f.type).split(" ")[0]]) for f in fields(kind)])
    return pa.table({f.name: [getattr(r, f.name) for r in rows] for f in fields(kind)}, schema=schema)


def _replace_file(table: pa.Table, path: Path) -> None:
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        pq.write_table(table, part, compression="zstd")
        if path.is_dir():
            shutil.rmtree(path)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def _replace_folder(table: pa.Table, path: Path) -> None:
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    shutil.rmtree(part, ignore_errors=True)
    ds.write_dataset(
        table, part, format="parquet", partitioning=["robot"], partitioning_flavor="hive", max_partitions=100_000
    )
    if path.is_dir():
        shutil.rmtree(path)
    path.unlink(missing_ok=True)
    part.rename(path)
