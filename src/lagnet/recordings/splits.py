"""Cuts recordings into samples to fit on and samples to judge by: whole motions or stretches of time.

Never single samples: neighbours share noise, filter and motion, so that a split by shuffled samples would let a model
be judged by what it has been fitted to.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.errors import RecordingError
from lagnet.percent import percent
from lagnet.recordings.recording import Recording

MIN_PART = 20  # samples of either side of a split below which nothing can be judged


@dataclass(frozen=True)
class Fold:
    """One way of cutting samples into those to fit and those to judge by.

    Args:
        fit: samples to fit on, increasing, shape (n_fit,).
        judge: samples to judge by, increasing, shape (n_judge,).
    """

    fit: np.ndarray
    judge: np.ndarray


def holdout_split(
    recordings: Sequence[Recording], fraction: float = 0.2
) -> tuple[tuple[Recording, ...], tuple[Recording, ...]]:
    """Keep the last part of each recording for judging: its last motions, or the last stretch of its only motion.

    Args:
        recordings: what there is.
        fraction: share of each recording that is held out, of its samples; whole motions come as near as they can.

    Returns:
        Recordings to fit on and recordings held out, one of each for every recording given, in order.

    Raises:
        RecordingError: a fraction outside (0, 1), or a recording too short to be cut.
    """
    if not 0 < fraction < 1:
        raise RecordingError(f"the held-out fraction must lie between 0 and 1, not {fraction:g}")
    pairs = [_cut(recording, fraction) for recording in recordings]
    return tuple(fit for fit, _ in pairs), tuple(held for _, held in pairs)


def _cut(recording: Recording, fraction: float) -> tuple[Recording, Recording]:
    starts = np.flatnonzero(np.diff(recording.trajectory)) + 1
    target = round(len(recording) * (1 - fraction))
    edge = int(starts[np.argmin(np.abs(starts - target))]) if starts.size else target
    if min(edge, len(recording) - edge) < MIN_PART:
        raise RecordingError(
            f"{len(recording)} samples are too few to hold out {percent(fraction)} of them",
            where=recording.path or None,
            next_step="give a separate recording to --holdout",
        )
    return _piece(recording, slice(0, edge)), _piece(recording, slice(edge, None))


def _piece(recording: Recording, rows: slice) -> Recording:
    """Some rows, with motions numbered from 0 again."""
    part = recording.rows(rows)
    labels, index = np.unique(part.trajectory, return_inverse=True)
    names = tuple(recording.trajectory_names[label] for label in labels)
    return replace(part, trajectory=index.astype(np.int64), trajectory_names=names)


def block_folds(recording: Recording, n_folds: int = 5, gap: float = 0.0) -> tuple[Fold, ...]:
    """Cut one recording into folds for cross-validation.

    Where there are as many motions as folds, each fold judges by whole motions; else by one stretch of time.

    Args:
        recording: the samples to cut.
        n_folds: number of folds, at least 2.
        gap: [s] left out of the fit on either side of a judged stretch of the same motion, so that filters and
            correlated noise do not leak across the cut.

    Raises:
        RecordingError: fewer than 2 folds, or too few samples for them.
    """
    n = len(recording)
    if n_folds < 2 or n < n_folds * MIN_PART:
        raise RecordingError(f"{n} samples cannot be cut into {n_folds} folds", where=recording.path or None)
    owner = fold_of_samples(recording.trajectory, n_folds)
    return tuple(_fold(recording, owner == k, gap) for k in range(n_folds))


def fold_of_samples(trajectory: np.ndarray, n_folds: int) -> np.ndarray:
    """The fold that judges by each sample, shape (n,): contiguous stretches of about equal length.

    Args:
        trajectory: shape (n,), motion of each sample, non-decreasing.
        n_folds: number of folds.
    """
    n, lengths = trajectory.size, np.bincount(trajectory)
    if lengths.size < n_folds:
        return np.arange(n) * n_folds // n
    # A motion goes to the fold in which its middle falls; every fold gets one motion at least.
    middle = np.cumsum(lengths) - lengths / 2
    fold = np.zeros(lengths.size, dtype=np.int64)
    previous = -1
    for k, wanted in enumerate((middle * n_folds / n).astype(np.int64)):
        needed = n_folds - lengths.size + k  # later motions must still reach the last fold
        previous = fold[k] = min(max(wanted, previous, needed), previous + 1, n_folds - 1)
    return fold[trajectory]


def _fold(recording: Recording, judged: np.ndarray, gap: float) -> Fold:
    near = np.zeros_like(judged)
    if gap > 0:
        for motion in np.unique(recording.trajectory[judged]):
            inside = recording.trajectory == motion
            span = recording.time[judged & inside]
            near |= inside & (recording.time >= span[0] - gap) & (recording.time <= span[-1] + gap)
    return Fold(np.flatnonzero(~(judged | near)), np.flatnonzero(judged))
