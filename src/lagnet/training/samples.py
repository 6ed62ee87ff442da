"""Recordings as arrays to train on: one row a sample, motion differentiated where it was not recorded."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.errors import RecordingError
from lagnet.recordings.recording import Recording
from lagnet.types import Trajectory

FEWEST = 40  # samples below which no network is worth training


@dataclass(frozen=True, eq=False)
class TrainingSamples:
    """Motion and torque, rows in the order of the recordings.

    Args:
        q, v, a, tau: shape (n, dof), SI units.
        joints: joint names in model order.
    """

    q: Trajectory
    v: Trajectory
    a: Trajectory
    tau: Trajectory
    joints: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.q)

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """(q, v, a, tau)."""
        return self.q, self.v, self.a, self.tau

    def sha256(self) -> str:
        """Checksum of all values, saved with every model."""
        digest = hashlib.sha256()
        for array in self.arrays:
            digest.update(np.ascontiguousarray(array, dtype=np.float64).tobytes())
        return digest.hexdigest()


def samples_of(recordings: Sequence[Recording]) -> TrainingSamples:
    """Put recordings one under the other.

    Where every recording holds v and a, its rows are taken as they are; else motion comes from conditioning, which
    filters and differentiates within each uninterrupted stretch.

    Raises:
        RecordingError: no recordings, other joints in one than in another, too few samples, or no torque that varies.
    """
    if not recordings:
        raise RecordingError("no recordings were given to train on")
    joints = recordings[0].joints
    for recording in recordings:
        if recording.joints != joints:
            raise RecordingError(
                f"joints {list(recording.joints)} are not those of the first recording, {list(joints)}",
                where=recording.path or None,
            )
    if all(r.v is not None and r.a is not None for r in recordings):
        columns = [[getattr(r, name) for r in recordings] for name in ("q", "v", "a", "torque")]
    else:
        from lagnet.recordings.conditioning.condition import condition

        stretches = condition(recordings).stretches
        columns = [[getattr(s, name) for s in stretches] for name in ("q", "v", "a", "tau")]
    q, v, a, tau = (np.concatenate(parts) for parts in columns)
    samples = TrainingSamples(q, v, a, tau, joints)
    _check(samples, recordings[0].path)
    return samples


def _check(samples: TrainingSamples, where: str) -> None:
    if len(samples) < FEWEST:
        raise RecordingError(
            f"{len(samples)} samples are too few to train on",
            where=where or None,
            next_step=f"record at least {FEWEST}",
        )
    if not np.any(samples.tau.std(axis=0) > 0):
        raise RecordingError("the torque never changes", where=where or None, next_step="record a moving arm")
