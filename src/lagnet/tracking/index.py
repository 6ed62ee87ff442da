"""A table of recordings for fleets too large for a manifest: robot, make, file, date; optionally temperature, gain."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from lagnet.errors import LagnetError
from lagnet.files import read_bounded
from lagnet.tracking.dates import parsed

COLUMNS = ("robot", "make", "file", "date")
MAX_BYTES = 512 * 1024**2
OPTIONAL = ("temperature", "gain")
MOST_GAIN = 1e6  # over the nominal gain
UNSAFE = set('/\\:*?"<>|')


@dataclass(frozen=True)
class IndexRow:
    """One recording of the table."""

    robot: str
    make: str
    file: str
    date: datetime
    temperature: float | None
    gain: float = 1.0


def read_index(path: Path) -> list[IndexRow]:
    """The recordings that a CSV file lists.

    Raises:
        LagnetError: not readable, a missing or unknown column, or a cell that cannot be read, with its line.
    """
    try:
        text = read_bounded(path, MAX_BYTES).decode("utf-8-sig")
        return list(_rows(csv.DictReader(io.StringIO(text, newline="")), str(path)))
    except OSError as error:
        raise LagnetError(f"cannot be read ({error.strerror})", where=str(path)) from None
    except (csv.Error, UnicodeDecodeError) as error:
        raise LagnetError(f"is not a CSV table ({error})", where=str(path)) from None


def _rows(table: csv.DictReader, where: str) -> Iterator[IndexRow]:
    names = [*(table.fieldnames or [])]
    missing = [c for c in COLUMNS if c not in names]
    unknown = [n for n in names if n not in (*COLUMNS, *OPTIONAL)]
    if missing or unknown:
        what = f"lacks the column {missing[0]}" if missing else f"the column {unknown[0]!r} means nothing here"
        raise LagnetError(what, where=where, choices=(*COLUMNS, *OPTIONAL))
    for row in table:
        place = f"{where}, line {table.line_num}"
        if None in row or any(not (row[c] or "").strip() for c in COLUMNS):
            raise LagnetError("a cell is empty or one too many", where=place, next_step="fill robot, make, file, date")
        robot = row["robot"].strip()
        if UNSAFE & set(robot) or not robot.strip(".") or not robot.isprintable():
            raise LagnetError(f"the name {robot!r} cannot be the name of a folder", where=place)
        date = parsed(row["date"], place)
        warm, gain = _number(row, "temperature", place), _number(row, "gain", place)
        if gain is not None and not 0.0 < gain < MOST_GAIN:
            step = "state it over the nominal gain, or leave it empty"
            raise LagnetError("gain must be a positive number", where=place, next_step=step)
        yield IndexRow(robot, row["make"].strip(), row["file"].strip(), date, warm, 1.0 if gain is None else gain)


def _number(row: dict[str, str | None], name: str, where: str) -> float | None:
    text = row.get(name)
    if text is None or not text.strip():
        return None
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise LagnetError(f"the {name} {text!r} is no number", where=where, next_step="leave unknown ones empty")
    return value
