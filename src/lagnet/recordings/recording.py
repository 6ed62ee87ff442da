"""What a robot did: joint motion, torque and commands on the clock of the file, immutable."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from lagnet.errors import RecordingError
from lagnet.recordings.signals import DRIVING, JOINT_SIGNALS
from lagnet.types import Samples, Trajectory


@dataclass(frozen=True, eq=False)
class Recording:
    """Samples of joint motion, torque and commands as they were recorded: nothing resampled, nothing filtered.

    At least one of `tau`, `current` and `command` says what moved the joints.

    Args:
        time: shape (n,), [s], strictly increasing within each trajectory.
        q: shape (n, dof), joint positions [rad] or [m].
        tau: shape (n, dof), joint torques [N m] or forces [N], or None where not recorded.
        joints: joint names in model order.
        v: shape (n, dof), joint velocities [rad/s], or None where not recorded.
        a: shape (n, dof), joint accelerations [rad/s²], or None where not recorded.
        trajectory: shape (n,), integer label of the motion a sample belongs to, in order of appearance from 0.
        trajectory_names: the file's own name of each label.
        path: where it was read from, "" for arrays.
        sha256: checksum of the file's bytes, "" for arrays.
        warnings: what the reader noticed and survived.
        command: shape (n, dof), commanded positions of position-controlled joints [rad] or [m], or None.
        command_velocity: shape (n, dof), commanded velocities [rad/s] or [m/s], or None.
        command_torque: shape (n, dof), commanded torques [N m] or [N], feed-forward of a controller, or None.
        enabled: shape (n, dof), 1 where the drive gives torque and 0 where it does not, or None.
        temperature: shape (n, dof), of the drives [°C], or None.
        voltage: shape (n, dof), supply of the drives [V], or None.
        duty: shape (n, dof), share of the supply that the drive puts on its motor, -1 to 1, or None.
        current: shape (n, dof), motor currents [A], or None.

    Raises:
        RecordingError: an array of another shape, or neither torque, current nor command.
        valid: shape (n,), False for samples that are set aside as bad data; None where all are used.
    """

    time: Samples
    q: Trajectory
    tau: Trajectory | None
    joints: tuple[str, ...]
    v: Trajectory | None = None
    a: Trajectory | None = None
    trajectory: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    trajectory_names: tuple[str, ...] = ("0",)
    path: str = ""
    sha256: str = ""
    warnings: tuple[str, ...] = ()
    command: Trajectory | None = None
    command_velocity: Trajectory | None = None
    command_torque: Trajectory | None = None
    enabled: Trajectory | None = None
    temperature: Trajectory | None = None
    voltage: Trajectory | None = None
    duty: Trajectory | None = None
    current: Trajectory | None = None
    valid: np.ndarray | None = None

    def __post_init__(self) -> None:
        if self.trajectory.size == 0 and self.time.size:
            object.__setattr__(self, "trajectory", np.zeros(self.time.size, dtype=np.int64))
        self._check_shapes()
        for name in ("time", "trajectory", "valid", *JOINT_SIGNALS):
            array = getattr(self, name)
            if array is not None:
                array = np.ascontiguousarray(array)
                array.setflags(write=False)
                object.__setattr__(self, name, array)

    def _check_shapes(self) -> None:
        shape = (self.time.size, len(self.joints))
        for name in JOINT_SIGNALS:
            array = getattr(self, name)
            if array is not None and array.shape != shape:
                raise RecordingError(
                    f"{name} has shape {array.shape}, expected {shape} (n_samples, n_dof)", where=self.path or None
                )
        if all(getattr(self, name) is None for name in DRIVING):
            raise RecordingError(
                "holds neither torque, motor current nor commands",
                where=self.path or None,
                next_step="one of them must say what moved the joints",
            )

    def __len__(self) -> int:
        return self.time.size

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        return len(self.joints)

    @property
    def has_torque(self) -> bool:
        """Whether joint torque was recorded, so that torques can be compared."""
        return self.tau is not None

    @property
    def torque(self) -> Trajectory:
        """Joint torques [N m] or forces [N], shape (n, dof), for what cannot do without.

        Raises:
            RecordingError: none were recorded.
        """
        if self.tau is None:
            held = "motor current without torque constants" if self.current is not None else "commands"
            raise RecordingError(
                f"holds no joint torque, only {held}",
                where=self.path or None,
                next_step="give a recording with tau_0, tau_1, …, or with current_0, … and torque constants [N m/A]",
            )
        return self.tau

    @property
    def signals(self) -> tuple[str, ...]:
        """Names of the joint signals that it holds: "q", "tau", "command", …"""
        return tuple(name for name in JOINT_SIGNALS if getattr(self, name) is not None)

    @property
    def rate(self) -> float:
        """Median rate [Hz] of the samples that are used, inside trajectories."""
        used = self.used()
        steps = np.diff(used.time)[np.diff(used.trajectory) == 0]
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
        kept = ("time", "trajectory", *self.signals, *(("valid",) if self.valid is not None else ()))
        return replace(self, **{name: getattr(self, name)[keep] for name in kept})

    def used(self, rows: slice = slice(None)) -> Recording:
        """The samples of some rows that are not set aside."""
        part = self if rows == slice(None) else self.rows(rows)
        if part.valid is None:
            return part
        return replace(part.rows(part.valid), valid=None)
