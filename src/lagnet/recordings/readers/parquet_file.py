"""Parquet tables: only the wanted columns are decoded; the declared size is checked before."""

from __future__ import annotations

import json
from collections.abc import Sequence

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from lagnet.errors import RecordingError
from lagnet.recordings.readers.source import Table, refuse_if_huge, table_of

JOINTS_KEY = b"lagnet_joints"  # file metadata: JSON list of joint names in column order


class ParquetSource:
    """An opened Parquet file; nothing but its footer has been parsed. `names` are those of its columns."""

    def __init__(self, data: bytes, where: str):
        self._where = where
        try:
            self._file = pq.ParquetFile(pa.BufferReader(data))
            self.names = tuple(self._file.schema_arrow.names)
        except (pa.ArrowException, OSError, UnicodeDecodeError) as error:  # the last: names that are no UTF-8
            raise RecordingError(
                f"cannot be read as Parquet ({_first_line(error)})", where=where, next_step="copy or write it again"
            ) from None

    @property
    def joints(self) -> tuple[str, ...] | None:
        """Joint names in the file's metadata, or None."""
        try:
            names = json.loads((self._file.schema_arrow.metadata or {})[JOINTS_KEY])
        except (KeyError, ValueError):
            return None
        return tuple(map(str, names)) if isinstance(names, list) else None

    def read(self, numbers: Sequence[str], label: str | None) -> Table:
        """Load the named columns."""
        wanted = [*numbers, *([] if label is None else [label])]
        refuse_if_huge(self._file.metadata.num_rows * len(wanted) * 8, self._where)
        try:
            table = self._file.read(columns=wanted, use_threads=False)
        except (pa.ArrowException, OSError) as error:
            raise RecordingError(
                f"is damaged ({_first_line(error)})", where=self._where, next_step="copy or write it again"
            ) from None
        columns = {name: _numbers(table.column(name), name, self._where) for name in numbers}
        if label is not None:
            columns[label] = _text(table.column(label), label, self._where)
        return table_of(columns, numbers, label, self._where)


def _numbers(column: pa.ChunkedArray, name: str, where: str) -> np.ndarray:
    kind = column.type
    if pa.types.is_dictionary(kind):
        kind = kind.value_type
    if not (pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_decimal(kind)):
        raise RecordingError(
            f"column {name} holds {kind}, not numbers", where=where, next_step="write it as float64 in SI units"
        )
    if pa.types.is_dictionary(column.type):
        column = column.cast(kind)
    # A clock in nanoseconds since 1970 is rounded to float64: the cast is allowed to.
    return column.cast(pa.float64(), safe=False).to_numpy()


def _text(column: pa.ChunkedArray, name: str, where: str) -> np.ndarray:
    if column.null_count:
        raise RecordingError(f"column {name} has empty cells", where=where, next_step="label every row")
    if pa.types.is_nested(column.type):
        raise RecordingError(f"column {name} holds {column.type}, not integers or text", where=where)
    return np.array(column.cast(pa.string()).to_pylist() or [], dtype=str)


def _first_line(error: BaseException) -> str:
    return str(error).splitlines()[0][:120] if str(error) else type(error).__name__
