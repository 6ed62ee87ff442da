"""Text tables (.csv, .csv.gz): comma, semicolon or tab, any line ending, damaged lines left out."""

from __future__ import annotations

import gzip
import io
import zlib
from collections.abc import Sequence

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv

from lagnet.errors import RecordingError
from lagnet.recordings.readers.bad_cells import read_cell_by_cell
from lagnet.recordings.readers.cut_line import whole_length
from lagnet.recordings.readers.dialect import sniff
from lagnet.recordings.readers.source import MAX_BYTES, RowNames, Table, as_labels, refuse_if_huge

MAX_DAMAGED = 0.1  # share of lines with a wrong number of cells above which the header, not the lines, is to blame
BLOCK = 4 * 1024**2  # bytes parsed at a time; no line of a recording is longer


class CsvSource:
    """An opened text table; nothing but its header has been parsed."""

    joints = None

    def __init__(self, data: bytes, where: str):
        self._where = where
        self._dialect, text = sniff(unzip(data, where) if data[:2] == b"\x1f\x8b" else data, where)
        whole = whole_length(text, self._dialect)
        self._cut_short = whole < len(text)
        self._text = pa.py_buffer(text).slice(0, whole)
        self._open_quote = _has_open_quote(text)

    @property
    def names(self) -> tuple[str, ...]:
        """Header cells, stripped; column_0, column_1, … where the file has no header."""
        return self._dialect.names

    def read(self, numbers: Sequence[str], label: str | None) -> Table:
        """Load the named columns; lines with too few or too many cells are left out and told."""
        damaged: list[int] = []
        table = self._table(numbers, label, damaged)
        columns = {name: table.column(_key(self.names.index(name))) for name in numbers}
        values = {name: column.to_numpy() for name, column in columns.items()}
        labels = None if label is None else table.column(_key(self.names.index(label))).to_numpy(zero_copy_only=False)
        return self._without_damage(values, labels, damaged)

    def _table(self, numbers: Sequence[str], label: str | None, damaged: list[int]) -> pa.Table:
        if self._open_quote:
            # The fast parser would take all lines up to the next quote for one cell.
            return read_cell_by_cell(self._text.to_pybytes(), self._dialect, numbers, label, damaged, self._where)
        try:
            return self._parse(numbers, label, None)
        except pa.ArrowInvalid:
            return self._parse_carefully(numbers, label, damaged)

    def _parse(self, numbers: Sequence[str], label: str | None, on_damage) -> pa.Table:
        types = {_key(self.names.index(name)): pa.float64() for name in numbers}
        if label is not None:
            types[_key(self.names.index(label))] = pa.string()
        dialect = self._dialect
        return pa_csv.read_csv(
            pa.BufferReader(self._text),
            read_options=pa_csv.ReadOptions(
                column_names=[_key(i) for i in range(len(self.names))],
                skip_rows=dialect.header_lines,
                # Line numbers of damaged lines are known only when one thread reads.
                use_threads=on_damage is None,
                block_size=BLOCK,
            ),
            parse_options=pa_csv.ParseOptions(
                delimiter=dialect.separator, invalid_row_handler=on_damage, ignore_empty_lines=False
            ),
            convert_options=pa_csv.ConvertOptions(
                column_types=types,
                include_columns=list(types),
                decimal_point=dialect.decimal,
                strings_can_be_null=False,
            ),
        )

    def _parse_carefully(self, numbers: Sequence[str], label: str | None, damaged: list[int]) -> pa.Table:
        def leave_out(row: pa_csv.InvalidRow) -> str:
            damaged.append(row.number)
            return "skip"

        try:
            return self._parse(numbers, label, leave_out)
        except pa.ArrowInvalid:
            damaged.clear()
            return read_cell_by_cell(self._text.to_pybytes(), self._dialect, numbers, label, damaged, self._where)

    def _without_damage(self, values: dict[str, np.ndarray], labels: np.ndarray | None, damaged: list[int]) -> Table:
        n_rows = next(iter(values.values())).size
        first = self._dialect.header_lines + 1
        if len(damaged) > max(1, MAX_DAMAGED * (n_rows + len(damaged))):
            raise RecordingError(
                f"{len(damaged)} of {n_rows + len(damaged)} lines do not have the {len(self.names)} cells"
                f" of the header, the first is line {damaged[0]}",
                where=self._where,
                next_step=f"give every line {len(self.names)} cells separated by {self._dialect.separator!r}",
            )
        numbers_of = RowNames("line", first, tuple(damaged))
        empty = np.logical_and.reduce([np.isnan(column) for column in values.values()])
        keep = ~empty
        warnings = self._tell(damaged, empty, numbers_of)
        kept = slice(None) if keep.all() else keep
        return Table(
            {name: column[kept] for name, column in values.items()},
            None if labels is None else as_labels(labels[kept]),
            numbers_of.without(np.flatnonzero(~keep)),
            warnings,
        )

    def _tell(self, damaged: list[int], empty: np.ndarray, rows: RowNames) -> tuple[str, ...]:
        told = []
        n_lines = empty.size + len(damaged) + self._dialect.header_lines
        inside = [line for line in damaged if line < n_lines]
        if self._cut_short or (damaged and damaged[-1] >= n_lines):
            told.append("the last line is cut short; it was dropped")
        if inside:
            told.append(
                f"{len(inside)} line{'s' * (len(inside) > 1)} with a wrong number of cells dropped,"
                f" the first is line {inside[0]}"
            )
        full = np.flatnonzero(~empty)
        gaps = np.flatnonzero(empty[: full[-1]]) if full.size else full
        if gaps.size:
            told.append(f"{gaps.size} empty line{'s' * (gaps.size > 1)} dropped, the first is {rows.of(int(gaps[0]))}")
        return tuple(told)


def unzip(data: bytes, where: str) -> bytes:
    """Decompress in bounded memory.

    Raises:
        RecordingError: damaged or cut-off archive, or more than `MAX_BYTES`.
    """
    try:
        with gzip.GzipFile(fileobj=io.BytesIO(data)) as stream:
            text = stream.read(MAX_BYTES + 1)
    except (gzip.BadGzipFile, EOFError, zlib.error) as error:
        what = "ends in the middle of its compressed data" if isinstance(error, EOFError) else "is damaged gzip"
        raise RecordingError(what, where=where, next_step="copy or download it again") from None
    refuse_if_huge(len(text), where)
    return text


def _has_open_quote(text: bytes) -> bool:
    """Whether a line opens a quote that it does not close."""
    return b'"' in text and any(line.count(b'"') % 2 for line in text.splitlines())


def _key(position: int) -> str:
    return f"c{position}"
