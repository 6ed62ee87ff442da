"""What a robot did: joint motion and torque on the clock of the file, immutable."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from lagnet.errors import RecordingError
from lagnet.types import Samples, Trajectory


@dataclass(frozen=True, eq=False)
class Recording:
    """Samples of joint motion and torque as they were recorded: nothing resampled, nothing filtered.

    Args:
        time: shape (n,), [s], strictly increasing within each trajectory.
        q: shape (n, dof), joint positions [rad] or [m].
        tau: shape (n, dof), joint torques [N m] or forces [N].
        joints: joint names in model order.
        v: shape (n, dof), joint velocities [rad/s], or None where not recorded.
        a: shape (n, dof), joint accelerations [rad/s²], or None where not recorded.
        trajectory: shape (n,), integer label of the motion a sample belongs to, in order of appearance from 0.
        trajectory_names: the file's own name of each label.
        path: where it was read from, "" for arrays.
        sha256: checksum of the file's bytes, "" for arrays.
        warnings: what the reader noticed and survived.
    """

    time: Samples
    q: Trajectory
    tau: Trajectory
    joints: tuple[str, ...]
    v: Trajectory | None = None
    a: Trajectory | None = None
    trajectory: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    trajectory_names: tuple[str, ...] = ("0",)
    path: str = ""
    sha256: str = ""
    warnings: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.trajectory.size == 0 and self.time.size:
            object.__setattr__(self, "trajectory", np.zeros(self.time.size, dtype=np.int64))
        self._check_shapes()
        for name in ("time", "q", "tau", "v", "a", "trajectory"):
            array = getattr(self, name)
            if array is not None:
                array = np.ascontiguousarray(array)
                array.setflags(write=False)
                object.__setattr__(self, name, array)

    def _check_shapes(self) -> None:
        shape = (self.time.size, len(self.joints))
        for name in ("q", "tau", "v", "a"):
            array = getattr(self, name)
            if array is not None and array.shape != shape:
                raise RecordingError(
                    f"{name} has shape {array.shape}, expected {shape} (n_samples, n_dof)", where=self.path or None
                )

    def __len__(self) -> int:
        return self.time.size

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        return len(self.joints)

    @property
    def rate(self) -> float:
        """Median sample rate [Hz] inside trajectories."""
        steps = np.diff(self.time)[np.diff(self.trajectory) == 0]
        return float(1.0 / np.median(steps)) if steps.size else 0.0

    @property
    def duration(self) -> float:
        """Recorded time [s], summed over trajectories."""
        return float(sum(part.time[-1] - part.time[0] for part in self.parts()))

    def parts(self) -> Iterator[Recording]:
        """The trajectories one by one, in order."""
        edges = np.flatnonzero(np.diff(self.trajectory)) + 1
        for rows in np.split(np.arange(len(self)), edges):
            if rows.size:
                yield self.rows(slice(rows[0], rows[-1] + 1))

    def rows(self, keep: slice | np.ndarray) -> Recording:
        """The same recording with some of its samples."""
        pick = {n: getattr(self, n)[keep] for n in ("time", "q", "tau", "trajectory")} | {
            n: None if getattr(self, n) is None else getattr(self, n)[keep] for n in ("v", "a")
        }
        return replace(self, **pick)
