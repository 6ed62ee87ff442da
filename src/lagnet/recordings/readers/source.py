"""What every reader gives: the names of the columns first, and then only the columns that are wanted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from lagnet.errors import RecordingError

MAX_BYTES = 2 * 1024**3  # of numbers or text after decompression: more is a mistake or an attack, not a motion
SPLIT_IT = "split it into several shorter recordings and give them together"


@dataclass(frozen=True)
class RowNames:
    """Tells a person where sample i stands in the file.

    Args:
        word: "line" in text files, "row" elsewhere.
        first: number of the first sample's row.
        left_out: numbers of the rows that the reader left out, increasing.
    """

    word: str = "row"
    first: int = 1
    left_out: tuple[int, ...] = ()

    def of(self, sample: int) -> str:
        """Name of the row that holds this sample (counted from 0)."""
        return f"{self.word} {self.numbers(np.array([sample]))[0]}"

    def numbers(self, samples: np.ndarray) -> np.ndarray:
        """Row numbers of samples, shape (k,)."""
        gone = np.asarray(self.left_out, dtype=np.int64)
        samples_before = gone - self.first - np.arange(gone.size)
        return self.first + samples + np.searchsorted(samples_before, samples, side="right")

    def without(self, samples: np.ndarray) -> RowNames:
        """The names of the rows that are left when these samples are taken out."""
        return RowNames(self.word, self.first, tuple(sorted([*self.left_out, *self.numbers(samples).tolist()])))


@dataclass(frozen=True)
class Table:
    """The columns that were asked for.

    Args:
        numbers: per column name the values, shape (n,), float64; an empty cell is NaN.
        labels: the trajectory column as text, shape (n,), or None.
        rows: where each sample stands in the file.
        warnings: what was noticed and survived.
    """

    numbers: dict[str, np.ndarray]
    labels: np.ndarray | None = None
    rows: RowNames = field(default_factory=RowNames)
    warnings: tuple[str, ...] = ()


class TableSource(Protocol):
    """An opened file."""

    @property
    def names(self) -> tuple[str, ...]:
        """All column names in file order, doubled ones included."""
        ...

    @property
    def joints(self) -> tuple[str, ...] | None:
        """Joint names that the file itself states for its numbered columns, or None."""
        ...

    def read(self, numbers: Sequence[str], label: str | None) -> Table:
        """Load the named columns as float64, and `label` as text."""
        ...


def refuse_if_huge(n_bytes: int, where: str) -> None:
    """Stop before memory is spent on more than any arm records.

    Raises:
        RecordingError: more than `MAX_BYTES` after decompression.
    """
    if n_bytes > MAX_BYTES:
        raise RecordingError(
            f"holds more than {MAX_BYTES / 1024**3:g} GiB after decompression", where=where, next_step=SPLIT_IT
        )


def as_labels(values: np.ndarray) -> np.ndarray:
    """Trajectory labels as text: 3, 3.0 and "3" are the same label.

    Args:
        values: shape (n,), integers, floats or strings.
    """
    values = np.asarray(values)
    if values.dtype.kind == "f" and np.all(values == np.round(values)):
        values = values.astype(np.int64)
    return values.astype(str)


def table_of(
    columns: dict[str, np.ndarray], numbers: Sequence[str], label: str | None, where: str, rows: RowNames | None = None
) -> Table:
    """Pick columns out of arrays that are in memory already.

    Raises:
        RecordingError: columns of different lengths, or values that are not numbers.
    """
    picked = {name: _as_numbers(columns[name], name, where) for name in numbers}
    lengths = {name: column.size for name, column in picked.items()}
    if label is not None:
        lengths[label] = columns[label].size
    if len(set(lengths.values())) > 1:
        told = ", ".join(f"{name} {length}" for name, length in lengths.items())
        raise RecordingError(
            f"the columns have different lengths ({told})", where=where, next_step="write them from one clock"
        )
    return Table(picked, None if label is None else as_labels(columns[label]), rows or RowNames())


def _as_numbers(values: np.ndarray, name: str, where: str) -> np.ndarray:
    if values.dtype.kind not in "fiub":
        raise RecordingError(
            f"column {name} holds {_kind(values)}, not numbers", where=where, next_step="write it as real numbers"
        )
    return values.astype(np.float64)


def _kind(values: np.ndarray) -> str:
    return {"U": "text", "S": "text", "O": "objects", "c": "complex numbers", "M": "dates", "m": "durations"}.get(
        values.dtype.kind, str(values.dtype)
    )
