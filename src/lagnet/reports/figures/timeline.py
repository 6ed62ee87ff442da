"""A time axis for motions one after the other, with few enough samples to draw."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.decomposition.decompose import Decomposition
from lagnet.reports.figures.decimation import extremes


@dataclass(frozen=True, eq=False)
class Timeline:
    """Samples to draw.

    Args:
        time: shape (m,), [s], motions laid end to end, nan between them.
        rows: shape (m,), index of each sample, −1 between motions.
    """

    time: np.ndarray
    rows: np.ndarray

    def of(self, values: np.ndarray) -> np.ndarray:
        """Values of shape (n,) at the samples drawn, nan between motions."""
        return np.where(self.rows < 0, np.nan, values[self.rows])


def timeline(parts: Decomposition, signal: np.ndarray, budget: int) -> Timeline:
    """Choose samples so that the peaks of a signal, shape (n,), stay."""
    edges = np.flatnonzero(np.diff(parts.trajectory)) + 1
    time, rows, clock = [], [], 0.0
    for own in np.split(np.arange(len(parts.time)), edges):
        chosen = own[extremes(signal[own], max(2, budget * len(own) // len(parts.time)))]
        time += [clock + parts.time[chosen] - parts.time[own[0]], [np.nan]]
        rows += [chosen, [-1]]
        clock += float(parts.time[own[-1]] - parts.time[own[0]])
    return Timeline(np.concatenate(time[:-1]), np.concatenate(rows[:-1]).astype(int))
