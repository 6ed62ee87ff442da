"""MATLAB files up to version 7 (`save -v7`): numeric arrays only, sizes checked before they are decompressed."""

from __future__ import annotations

import io
import warnings
from collections.abc import Sequence

import numpy as np
import scipy.io

from lagnet.errors import RecordingError
from lagnet.recordings.readers.arrays import column, columns_of
from lagnet.recordings.readers.mat_layout import check_layout
from lagnet.recordings.readers.source import Table, refuse_if_huge, table_of

NUMERIC = ("double", "single", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64", "logical")
HDF5 = b"\x89HDF"


class MatArrays:
    """The numeric arrays of a .mat file; structs, cells, objects and functions are never built."""

    def __init__(self, data: bytes, where: str):
        self._data, self._where = data, where
        if data[:4] == HDF5 or b"MATLAB 7.3" in data[:128]:
            raise RecordingError(
                "is a MATLAB 7.3 (HDF5) file, which is not read", where=where, next_step="save it with the option -v7"
            )
        self._guarded(lambda stream: check_layout(stream.getvalue(), where))
        listed = self._guarded(scipy.io.whosmat)
        self.shapes = {name: tuple(shape) for name, shape, kind in listed if kind in NUMERIC}

    def array(self, name: str) -> np.ndarray:
        """One array, as stored."""
        refuse_if_huge(int(np.prod(self.shapes[name], dtype=object)) * 8, self._where)
        return self._guarded(scipy.io.loadmat, variable_names=[name])[name]

    def _guarded(self, read, **options):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # scipy warns of doubled variables; the columns wanted are checked here
                return read(io.BytesIO(self._data), **options)
        except (MemoryError, RecordingError):
            raise
        except Exception:
            # A damaged file makes scipy's parser fail in many ways (struct.error, zlib.error, IndexError, …).
            raise RecordingError(
                "cannot be read as a MATLAB file", where=self._where, next_step="save it again with the option -v7"
            ) from None


class MatSource:
    """An opened .mat file; its arrays are seen as columns."""

    joints = None

    def __init__(self, data: bytes, where: str):
        self._where = where
        self._arrays = MatArrays(data, where)
        self._columns = columns_of(self._arrays.shapes)
        if "time" not in self._columns and [s for s in self._arrays.shapes.values() if s[-1:] == (28,)]:
            raise RecordingError(
                "holds rows of 28 columns without time, as the SARCOS files do: shuffled samples are no motion",
                where=where,
                next_step="load it with lagnet.recordings.datasets.sarcos.load_sarcos",
            )

    @property
    def names(self) -> tuple[str, ...]:
        """Column names: q_0, q_1, … for an array q of shape (n, dof)."""
        return tuple(self._columns)

    def read(self, numbers: Sequence[str], label: str | None) -> Table:
        """Load the named columns."""
        wanted = [*numbers, *([] if label is None else [label])]
        arrays = {name: self._arrays.array(name) for name in sorted({self._columns[n][0] for n in wanted})}
        columns = {name: column(arrays[self._columns[name][0]], self._columns[name][1]) for name in wanted}
        return table_of(columns, numbers, label, self._where)
