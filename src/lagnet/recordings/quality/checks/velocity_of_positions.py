"""Recorded speeds that are not those of the recorded positions: another unit, sign, joint or clock."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lagnet.recordings.quality.check import QualityCheck, Subject
from lagnet.recordings.quality.finding import CERTAIN, LIKELY, Finding
from lagnet.recordings.quality.runs import resolution

ALIKE = 0.98  # correlation of recorded speed and the rate at which the position changes
UNLIKE = 0.5  # below which the recorded speed is none of this joint
FACTOR = 0.2  # by which the two may differ in size before a unit is told
QUANTA = 50.0  # steps of the scale over which a joint must range


class VelocityOfPositions(QualityCheck):
    """The recorded speed of each joint against the rate at which its position changes."""

    name = "velocity_of_positions"
    title = "recorded speeds are not those of the positions"
    meaning = "Speeds in another unit or order would be told as friction; a clock in another unit shows in them first."

    def find(self, subject: Subject) -> Iterator[Finding]:
        recording = subject.recording
        if recording.v is None or not subject.stretches:
            return
        moved, travelled = _travelled(subject)
        power = np.sum(moved**2, axis=0), np.sum(travelled**2, axis=0)
        known = (power[0] > 0) & (power[1] > 0) & subject.moves & _resolved(recording.q)
        likeness = np.sum(moved * travelled, axis=0) / np.sqrt(np.maximum(power[0] * power[1], 1e-300))
        factor = np.sum(moved * travelled, axis=0) / np.maximum(power[1], 1e-300)
        off = known & (np.abs(likeness) > ALIKE) & (np.abs(factor - 1.0) > FACTOR)
        common = float(np.median(factor[known])) if known.any() else 1.0
        if off.sum() >= max(2, 0.7 * known.sum()) and np.ptp(factor[off]) < FACTOR * abs(common) and common > 0:
            yield self._of_clock_or_unit(subject, common)
            return
        for j in np.flatnonzero(off):
            yield self.found(
                subject,
                f"{subject.named('v', int(j))} is {1 / factor[j]:.4g} times the rate at which q_{j} changes:"
                f" another {'sign' if abs(factor[j] + 1) < FACTOR else 'unit'}; the recorded speeds were not used",
                f'[scale] "v_{j}" = {factor[j]:.6g}',
                CERTAIN,
                channel=f"v_{j}",
            )
        for j in np.flatnonzero(known & (np.abs(likeness) < UNLIKE)):
            yield self.found(
                subject,
                f"{subject.named('v', int(j))} is not the rate at which q_{j} changes (correlation {likeness[j]:.2f}):"
                " the columns are of different joints, or one of them is wrong",
                f'[columns] "v_{j}" = "..."',
                LIKELY,
                channel=f"v_{j}",
            )

    def _of_clock_or_unit(self, subject: Subject, factor: float) -> Finding:
        return self.found(
            subject,
            f"the recorded speeds of all joints are {1 / factor:.4g} times the rate at which the positions change:"
            " the clock or the speeds are in another unit",
            f"[scale] time = {1.0 * factor:.6g} if the clock is wrong, [scale] v = {factor:.6g} if the speeds are",
            CERTAIN,
            channel="time v",
            harmful=True,
        )


def _resolved(q: np.ndarray) -> np.ndarray:
    """Whether each joint ranges over many steps of its scale, shape (dof,)."""
    low, high = np.quantile(q, [0.02, 0.98], axis=0)
    return high - low > QUANTA * np.array([resolution(q[:, j]) for j in range(q.shape[1])])


def _travelled(subject: Subject) -> tuple[np.ndarray, np.ndarray]:
    """Way between samples some way apart by positions and by recorded speeds, shapes (n, dof)."""
    recording = subject.recording
    assert recording.v is not None
    moved, travelled = [], []
    for rows in subject.stretches:
        time, q, v = recording.time[rows], recording.q[rows], recording.v[rows]
        path = np.concatenate(
            [np.zeros((1, q.shape[1])), np.cumsum(0.5 * (v[1:] + v[:-1]) * np.diff(time)[:, None], axis=0)]
        )
        every = max(1, min(8, rows.size // 16))
        moved.append(np.diff(q[::every], axis=0))
        travelled.append(np.diff(path[::every], axis=0))
    return np.concatenate(moved), np.concatenate(travelled)
