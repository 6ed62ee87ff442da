"""Error of modelled torque at 5 Hz, from the table of held-out torques alone: shares no code with the diagnosis."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
from scipy.signal import butter, sosfiltfilt

BANDWIDTH = 5.0  # [Hz]
ORDER = 4
GAP = 8.0  # median steps without a sample that end a stretch
SHORTEST = 1.0  # [s] of a stretch that can be filtered at 5 Hz


def read_torques(path: Path) -> dict[str, np.ndarray]:
    """Columns of holdout_torque.parquet."""
    return {name: np.asarray(column) for name, column in pq.read_table(path).to_pydict().items()}


def nmse(table: dict[str, np.ndarray], joint: int, kind: str) -> float:
    """Power of (measured − modelled) over the variance of measured torque, both low-passed.

    Args:
        table: of `read_torques`.
        joint: index.
        kind: "nominal" or "corrected".
    """
    errors, torques = [], []
    for rows in stretches(table):
        time = table["time"][rows]
        measured = low_passed(time, table[f"tau_measured_{joint}"][rows])
        errors.append(measured - low_passed(time, table[f"tau_{kind}_{joint}"][rows]))
        torques.append(measured)
    return float(np.mean(np.concatenate(errors) ** 2) / np.var(np.concatenate(torques)))


def stretches(table: dict[str, np.ndarray]) -> Iterator[slice]:
    """Rows without a gap, of one recording, long enough to be filtered."""
    time = table["time"]
    steps = np.diff(time)
    cut = (steps <= 0) | (steps > GAP * np.median(steps[steps > 0]))
    if "recording" in table:
        cut |= table["recording"][1:] != table["recording"][:-1]
    edges = [0, *(np.flatnonzero(cut) + 1).tolist(), time.size]
    for first, last in pairwise(edges):
        if time[last - 1] - time[first] > SHORTEST:
            yield slice(first, last)


def low_passed(time: np.ndarray, x: np.ndarray) -> np.ndarray:
    """The part of a signal below 5 Hz, on an even clock, without phase shift."""
    step = float(np.median(np.diff(time)))
    clock = np.arange(time[0], time[-1], step)
    sections = butter(ORDER, BANDWIDTH, fs=1.0 / step, output="sos")
    return sosfiltfilt(sections, np.interp(clock, time, x), padlen=min(clock.size - 1, int(1.0 / step)))
