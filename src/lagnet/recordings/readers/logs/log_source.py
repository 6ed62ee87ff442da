"""A foreign log in memory, seen as a table: its columns carry the names of the recording contract."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.recordings.readers.source import RowNames, Table, table_of


@dataclass(frozen=True)
class Origin:
    """What a file was recognised as.

    Args:
        format: name of the format for people.
        recognised_by: what in the file says so.
        clock: where its time comes from.
        clock_recorded: False where time was made from frame numbers.
        effort: where the torque column comes from, "" where there is none.
    """

    format: str
    recognised_by: str
    clock: str = "the column time"
    clock_recorded: bool = True
    effort: str = "the column tau"


@dataclass(frozen=True, eq=False)
class LogSource:
    """An opened log.

    Args:
        origin: what it was recognised as.
        columns: name to values, shape (n,), names as in the recording contract, `q_0`, `command_0`, …
        joints: names of the numbered joints, or None where the log does not name them.
        labels: shape (n,), the motion of each sample, or None.
        warnings: what was noticed and survived.
        where: the file.
    """

    origin: Origin
    columns: dict[str, np.ndarray]
    joints: tuple[str, ...] | None
    where: str
    labels: np.ndarray | None = None
    warnings: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """Column names."""
        return (*self.columns, *(() if self.labels is None else ("trajectory",)))

    def read(self, numbers: Sequence[str], label: str | None) -> Table:
        """Pick the named columns."""
        columns = self.columns if self.labels is None else self.columns | {"trajectory": self.labels}
        table = table_of(columns, numbers, label, self.where, RowNames("sample"))
        return replace(table, warnings=self.warnings)


def held(stamps: np.ndarray, values: np.ndarray, at: np.ndarray) -> np.ndarray:
    """The last value that came at or before each time; NaN before the first.

    Args:
        stamps: shape (m,), increasing.
        values: shape (m, k).
        at: shape (n,), times on the same clock.
    """
    last = np.searchsorted(stamps, at, side="right") - 1
    found = values[np.maximum(last, 0)].astype(np.float64)
    found[last < 0] = np.nan
    return found


def per_joint(kind: str, values: np.ndarray) -> dict[str, np.ndarray]:
    """The columns kind_0, kind_1, … of an array of shape (n, dof); joints without any number are left out."""
    return {f"{kind}_{j}": values[:, j] for j in range(values.shape[1]) if np.isfinite(values[:, j]).any()}


def from_first_command(
    columns: dict[str, np.ndarray], labels: np.ndarray | None = None
) -> tuple[dict[str, np.ndarray], np.ndarray | None, tuple[str, ...]]:
    """The log from its first command on; before it, nothing says what the controller was told.

    Where commands begin in the second half only, they are left out instead.
    """
    commands = [name for name in columns if name.startswith("command")]
    if not commands:
        return columns, labels, ()
    known = np.logical_and.reduce([np.isfinite(columns[name]) for name in commands])
    missing = int((~known).sum())
    if not missing:
        return columns, labels, ()
    if missing > known.size / 2:
        kept = {name: values for name, values in columns.items() if name not in commands}
        return kept, labels, (f"{missing} of {known.size} samples have no command: the commands were not read",)
    told = (f"{missing} samples before the first command were left out",)
    return {n: v[known] for n, v in columns.items()}, None if labels is None else labels[known], told
