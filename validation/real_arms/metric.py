"""Error of modelled torque at 5 Hz, from the table of held-out torques: shares no code with the diagnosis."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
from scipy.signal import butter, sosfiltfilt

from lagnet.recordings.recording import Recording

BANDWIDTH = 5.0  # [Hz]
ORDER = 4
GAP = 8.0  # median steps without a sample that end a stretch
SHORTEST = 1.0  # [s] of a stretch that can be filtered at 5 Hz
STILL = 0.01  # of a joint's largest speed: below it for all joints the arm rests


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
    _, error, torque = _signals(table, joint, kind)
    return float(np.mean(error**2) / np.var(torque))


def at_rest(table: dict[str, np.ndarray], joint: int, kind: str, recording: Recording) -> tuple[float, float]:
    """What rest has of the error, in a recording by itself, and nMSE over the samples in motion alone.

    While an arm rests, dry friction holds with any torque below its break-away, and the controller decides which.

    Args:
        table, joint, kind: as for `nmse`.
        recording: the one that the table is of.
    """
    time, error, torque = _signals(table, joint, kind)
    smooth = [low_passed(recording.time, recording.q[:, j]) for j in range(recording.n_dof)]
    speed = np.abs(np.diff(smooth, axis=1))  # per step: compared with its own largest alone
    still = np.all(speed < STILL * speed.max(axis=1, keepdims=True), axis=0)
    rests = np.interp(time, np.linspace(recording.time[0], recording.time[-1], still.size), still.astype(float)) > 0.5
    share = float(np.sum(error[rests] ** 2) / np.sum(error**2))
    return share, float(np.mean(error[~rests] ** 2) / np.var(torque[~rests]))


def _signals(table: dict[str, np.ndarray], joint: int, kind: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times, error and measured torque over all stretches, both torques low-passed."""
    times, errors, torques = [], [], []
    for rows in stretches(table):
        time = table["time"][rows]
        measured = low_passed(time, table[f"tau_measured_{joint}"][rows])
        errors.append(measured - low_passed(time, table[f"tau_{kind}_{joint}"][rows]))
        torques.append(measured)
        times.append(np.linspace(time[0], time[-1], measured.size))
    return np.concatenate(times), np.concatenate(errors), np.concatenate(torques)


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
