"""NumPy archives: `time, q, v, a, tau` or single columns; never unpickled, sizes checked before memory is spent."""

from __future__ import annotations

import io
import lzma
import struct
import zipfile
import zlib
from collections.abc import Sequence

import numpy as np
from numpy.lib import format as npy

from lagnet.errors import RecordingError
from lagnet.recordings.readers.arrays import column, columns_of, expand_offsets
from lagnet.recordings.readers.source import Table, refuse_if_huge, table_of

DAMAGED = (  # what archives fail with: encrypted, of a method that is not known, cut off, or of wrong sums
    ValueError,
    EOFError,
    OSError,
    OverflowError,
    zlib.error,
    lzma.LZMAError,
    zipfile.BadZipFile,
    RuntimeError,
    NotImplementedError,
    struct.error,
)
COPY_AGAIN = "copy or write it again"


class NpzArchive:
    """The arrays of a .npz file, read one by one, with object arrays and oversized ones refused."""

    def __init__(self, data: bytes, where: str):
        self._where = where
        try:
            self._zip = zipfile.ZipFile(io.BytesIO(data))
        except (zipfile.BadZipFile, ValueError, OverflowError, OSError, NotImplementedError, struct.error):
            raise RecordingError(
                "is no NumPy archive, or is damaged", where=where, next_step="write it with numpy.savez_compressed"
            ) from None
        refuse_if_huge(sum(member.file_size for member in self._zip.infolist()), where)
        self.headers = {
            member.filename.removesuffix(".npy"): self._header(member)
            for member in self._zip.infolist()
            if member.filename.endswith(".npy")
        }

    @property
    def shapes(self) -> dict[str, tuple[int, ...]]:
        """Shape of every array."""
        return {name: shape for name, (shape, _) in self.headers.items()}

    def array(self, name: str) -> np.ndarray:
        """One array.

        Raises:
            RecordingError: objects instead of numbers, or damaged content.
        """
        shape, dtype = self.headers[name]
        if dtype.hasobject:
            raise RecordingError(
                f"array {name} holds Python objects, which are never loaded",
                where=self._where,
                next_step="save plain arrays of numbers or strings",
            )
        refuse_if_huge(int(np.prod(shape, dtype=object)) * dtype.itemsize, self._where)
        try:
            with self._zip.open(f"{name}.npy") as stream:
                return npy.read_array(stream, allow_pickle=False)
        except DAMAGED:
            raise RecordingError(f"array {name} is damaged", where=self._where, next_step=COPY_AGAIN) from None

    def _header(self, member: zipfile.ZipInfo) -> tuple[tuple[int, ...], np.dtype]:
        try:
            with self._zip.open(member) as stream:
                version = npy.read_magic(stream)
                read = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
                shape, _, dtype = read(stream)
        except DAMAGED:
            raise RecordingError(
                f"array {member.filename} is damaged or encrypted", where=self._where, next_step=COPY_AGAIN
            ) from None
        return shape, dtype


class NpzSource:
    """An opened archive; its arrays are seen as columns."""

    def __init__(self, data: bytes, where: str):
        self._where = where
        self._archive = NpzArchive(data, where)
        self._columns = columns_of({n: s for n, s in self._archive.shapes.items() if n not in ("joints", "labels")})
        if "offsets" in self._columns and "trajectory" not in self._columns:
            self._columns["trajectory"] = ("offsets", None)

    @property
    def names(self) -> tuple[str, ...]:
        """Column names: q_0, q_1, … for an array q of shape (n, dof)."""
        return tuple(self._columns)

    @property
    def joints(self) -> tuple[str, ...] | None:
        """Joint names in the array `joints`, or None."""
        shape, dtype = self._archive.headers.get("joints", ((), np.dtype(float)))
        if len(shape) != 1 or dtype.kind not in "US":
            return None
        return tuple(map(str, self._archive.array("joints")))

    def read(self, numbers: Sequence[str], label: str | None) -> Table:
        """Load the named columns."""
        wanted = {self._columns[name][0] for name in numbers} | ({label} if label in self._archive.headers else set())
        arrays = {name: self._archive.array(name) for name in sorted(wanted)}
        columns = {name: column(arrays[self._columns[name][0]], self._columns[name][1]) for name in numbers}
        if label is not None:
            n_rows = next(iter(columns.values())).size
            columns[label] = self._labels(n_rows) if label not in arrays else column(arrays[label], None)
        return table_of(columns, numbers, label, self._where)

    def _labels(self, n_rows: int) -> np.ndarray:
        names = self._archive.array("labels") if "labels" in self._archive.headers else None
        return expand_offsets(self._archive.array("offsets"), names, n_rows, self._where)
