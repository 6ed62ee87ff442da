"""Reads a text table cell by cell: slow, and only for tables that the fast parser refused, to say which cell is bad."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence

import pyarrow as pa

from lagnet.errors import RecordingError
from lagnet.recordings.readers.dialect import NUMBER, Dialect

NOT_A_NUMBER = frozenset({"", "nan", "na", "n/a", "null", "none", "#n/a"})
INFINITE = frozenset({"inf", "infinity"})


def read_cell_by_cell(
    text: bytes, dialect: Dialect, numbers: Sequence[str], label: str | None, damaged: list[int], where: str
) -> pa.Table:
    """The wanted columns of a table that may have a cell which is no number.

    Args:
        damaged: filled with the line numbers that have a wrong number of cells.

    Raises:
        RecordingError: names the line and column of the first cell that is not a number.
    """
    spots = [dialect.names.index(name) for name in numbers]
    label_spot = None if label is None else dialect.names.index(label)
    columns: list[list[float]] = [[] for _ in spots]
    labels: list[str] = []
    for line, cells in _rows(text, dialect, where):
        if not cells:
            cells = [""] * len(dialect.names)
        if len(cells) != len(dialect.names):
            damaged.append(line)
            continue
        values = [_number(cells[spot], dialect.decimal) for spot in spots]
        if None in values:
            _refuse(line, numbers[values.index(None)], cells[spots[values.index(None)]], where)
        for column, value in zip(columns, values, strict=True):
            column.append(float("nan") if value is None else value)
        labels.append("" if label_spot is None else cells[label_spot])
    arrays = {f"c{spot}": pa.array(column, pa.float64()) for spot, column in zip(spots, columns, strict=True)}
    if label_spot is not None:
        arrays[f"c{label_spot}"] = pa.array(labels, pa.string())
    return pa.table(arrays)


def _rows(text: bytes, dialect: Dialect, where: str) -> Iterator[tuple[int, list[str]]]:
    """Line number and cells; quotes do not reach over line ends, as in the fast parser."""
    lines = io.TextIOWrapper(io.BytesIO(text), encoding="utf-8", newline=None)
    for number, line in enumerate(lines, start=1):
        if number <= dialect.header_lines:
            continue
        plain = line.rstrip("\n")
        try:
            cells = next(csv.reader([plain], delimiter=dialect.separator)) if '"' in plain else _split(plain, dialect)
        except csv.Error as error:
            raise RecordingError(f"line {number}: {error}", where=where, next_step="save it as plain CSV") from None
        yield number, cells


def _split(line: str, dialect: Dialect) -> list[str]:
    return line.split(dialect.separator) if line else []


def _number(cell: str, decimal: str) -> float | None:
    """The number in a cell, NaN for the usual words for "missing", None for text."""
    plain = cell.strip().replace(",", ".") if decimal == "," else cell.strip()
    if NUMBER.fullmatch(plain):
        return float(plain)
    bare = plain.lower().lstrip("+-")
    if bare in INFINITE:
        return float("inf")
    return float("nan") if bare in NOT_A_NUMBER else None


def _refuse(line: int, column: str, cell: str, where: str) -> None:
    shown = cell if len(cell) <= 40 else cell[:37] + "..."
    raise RecordingError(
        f"line {line}, column {column}: {shown!r} is not a number",
        where=where,
        next_step="write a plain number with a decimal point, or remove the line",
    )
