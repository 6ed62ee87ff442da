"""Tables that robots' own software writes: foreign column names that are known, seen under the contract's names."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from lagnet.recordings.readers.logs.log_source import Origin
from lagnet.recordings.readers.source import Table, TableSource


@dataclass(frozen=True)
class Vocabulary:
    """The column names of one program.

    Args:
        origin: what it is called, and what in the header says so.
        needed: columns that must be there, or the table is none of it.
        time: name of the clock, and the seconds in one of its units.
        signals: kind of the contract to the program's name; {i} counts from 0; several names: the first that is there.
        joints: how many joints.
        notes: column pattern to what must be said of it.
    """

    origin: Origin
    needed: tuple[str, ...]
    time: tuple[str, float]
    signals: dict[str, tuple[str, ...]]
    joints: int
    notes: dict[str, str] = field(default_factory=dict)

    def fits(self, names: Sequence[str]) -> bool:
        """Whether a table with these columns was written by that program."""
        return set(self.needed) <= set(names)


class KnownTable:
    """A table whose foreign columns also answer to the names of the contract."""

    def __init__(self, table: TableSource, vocabulary: Vocabulary):
        self._table, self._vocabulary = table, vocabulary
        self.origin, self.joints = vocabulary.origin, table.joints
        self._ours = self._renamed()

    @property
    def names(self) -> tuple[str, ...]:
        """The file's own columns, and ours."""
        return (*self._table.names, *(name for name in self._ours if name not in self._table.names))

    def read(self, numbers: Sequence[str], label: str | None) -> Table:
        """Load the named columns, by whichever name."""
        theirs = list(dict.fromkeys(self._ours.get(name, name) for name in numbers))
        table = self._table.read(theirs, label)
        clock, unit = self._vocabulary.time
        # Milliseconds are divided: 1e-3 is not the inverse of a thousand in binary.
        found = {name: table.numbers[self._ours.get(name, name)] for name in numbers}
        if "time" in found and self._ours.get("time") == clock and unit != 1.0:
            found["time"] = found["time"] / np.round(1.0 / unit)
        return replace(table, numbers=found, warnings=(*table.warnings, *self._told()))

    def _renamed(self) -> dict[str, str]:
        have, vocabulary = set(self._table.names), self._vocabulary
        found = {"time": vocabulary.time[0]}
        for kind, patterns in vocabulary.signals.items():
            for pattern in patterns:
                columns = [pattern.replace("{i}", str(i)) for i in range(vocabulary.joints)]
                if have.issuperset(columns):
                    found |= {f"{kind}_{i}": column for i, column in enumerate(columns)}
                    break
        return found

    def _told(self) -> tuple[str, ...]:
        names = self._table.names
        return tuple(
            text for pattern, text in self._vocabulary.notes.items() if any(re.fullmatch(pattern, n) for n in names)
        )
