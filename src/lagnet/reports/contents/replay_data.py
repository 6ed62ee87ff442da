"""What a replay of recordings through the user's simulator leaves for a report to draw."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

GAP = 1.5  # times the median period from which a stretch has ended


@dataclass(frozen=True)
class ReplayData:
    """What a replay found.

    Args:
        summary: as in replay.json.
        columns: as in replay.parquet, by column: recording, time, q_measured_i, q_before_i, q_after_i.
    """

    summary: Mapping[str, Any]
    columns: Mapping[str, Any]

    @property
    def joints(self) -> list[str]:
        """Joint names in model order."""
        return list(self.summary["joints"])

    @property
    def units(self) -> list[str]:
        """Unit of each joint's position, rad or m."""
        return list(self.summary.get("units", ["rad"] * len(self.joints)))

    @property
    def unit(self) -> str:
        """Unit of errors over all joints."""
        return " or ".join(sorted(set(self.units), reverse=True))

    @property
    def sides(self) -> tuple[str, ...]:
        """'before' and, where there is a corrected model, 'after'."""
        return ("before",) if self.summary["after"] is None else ("before", "after")

    @property
    def time(self) -> np.ndarray:
        """Time of every row, shape (n,) [s]; every stretch has a clock of its own."""
        return np.asarray(self.columns["time"], dtype=float)

    def signal(self, name: str, joint: int, rows: np.ndarray) -> np.ndarray:
        """A column of a joint at some rows."""
        return np.asarray(self.columns[f"{name}_{joint}"], dtype=float)[rows]

    def longest(self) -> np.ndarray:
        """Rows of the longest stretch of one recording whose clock runs on."""
        names, step = np.asarray(self.columns["recording"]), np.diff(self.time)
        even = (step > 0) & (step < GAP * np.median(step))
        breaks = np.flatnonzero((names[1:] != names[:-1]) | ~even) + 1
        return max(np.split(np.arange(self.time.size), breaks), key=len)

    def recording(self, rows: np.ndarray) -> str:
        """Name of the recording that rows belong to."""
        return str(self.columns["recording"][rows[0]])
