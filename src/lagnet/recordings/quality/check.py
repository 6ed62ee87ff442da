"""What a check of data is: one fault that measured signals can have, looked for in one recording."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from lagnet.recordings.conditioning.stretches import stretches_of
from lagnet.recordings.quality.finding import NO_ROWS, Finding
from lagnet.recordings.recording import Recording

KINDS = ("q", "v", "tau")
UNITS = {"q": ("rad", "m"), "v": ("rad/s", "m/s"), "tau": ("N m", "N")}  # of revolute and of prismatic joints
MOTION = 1e-3  # [rad] or [m] that a joint must range over to be called moving
FEW = 8  # samples of a stretch below which nothing is looked for in it


@dataclass(frozen=True)
class JointLimits:
    """What the robot's description says of its joints; inf where it says nothing.

    Args:
        velocity: shape (dof,), [rad/s] or [m/s].
        effort: shape (dof,), [N m] or [N].
        prismatic: which joints are, shape (dof,); None where no description is given.
    """

    velocity: np.ndarray
    effort: np.ndarray
    prismatic: np.ndarray | None = None


def no_limits(n_dof: int) -> JointLimits:
    """Nothing is known of the joints."""
    return JointLimits(np.full(n_dof, np.inf), np.full(n_dof, np.inf))


@dataclass(frozen=True, eq=False)
class Subject:
    """A recording as the checks see it.

    Args:
        recording: with the samples that earlier checks set aside marked in `valid`.
        limits: of its joints.
    """

    recording: Recording
    limits: JointLimits

    @cached_property
    def stretches(self) -> tuple[np.ndarray, ...]:
        """Rows of each uninterrupted stretch less the samples set aside."""
        valid = self.recording.valid
        rows = [np.arange(s.start, s.stop) for s in stretches_of(self.recording)]
        rows = rows if valid is None else [r[valid[r]] for r in rows]
        return tuple(r for r in rows if r.size >= FEW)

    @cached_property
    def moves(self) -> np.ndarray:
        """Whether each joint moves, shape (dof,)."""
        q = self.recording.q[np.concatenate(self.stretches)] if self.stretches else self.recording.q
        low, high = np.quantile(q, [0.02, 0.98], axis=0)
        return high - low > MOTION

    def signals(self) -> Iterator[tuple[str, np.ndarray]]:
        """The kinds of signal that were recorded, each of shape (n, dof)."""
        for kind in KINDS:
            values = getattr(self.recording, kind)
            if values is not None:
                yield kind, values

    def named(self, kind: str, joint: int) -> str:
        """A column for people, such as "tau_2 (elbow_joint)"."""
        return f"{kind}_{joint} ({self.recording.joints[joint]})"

    def unit(self, kind: str, joint: int) -> str:
        """The unit of a signal, such as "rad/s"; both where nobody says what the joint is."""
        revolute, prismatic = UNITS[kind]
        if self.limits.prismatic is None:
            return f"{revolute} or {prismatic}"
        return prismatic if self.limits.prismatic[joint] else revolute

    def span(self, rows: np.ndarray) -> tuple[float, float]:
        """First and last time of some rows [s]."""
        time = self.recording.time
        return float(time[rows[0]]), float(time[rows[-1]])


class QualityCheck(ABC):
    """One fault. A variant is a new file in `checks/` and a line in `CHECKS`."""

    name: ClassVar[str]
    title: ClassVar[str]  # what is wrong, in a few words
    meaning: ClassVar[str]  # one sentence: what it would be taken for
    source: ClassVar[str] = ""

    @abstractmethod
    def find(self, subject: Subject) -> Iterator[Finding]:
        """What is wrong with one recording; nothing where it is sound."""

    def found(
        self,
        subject: Subject,
        detail: str,
        mend: str,
        certainty: str,
        *,
        channel: str = "",
        rows: np.ndarray | None = None,
        set_aside: np.ndarray = NO_ROWS,
        harmful: bool = False,
        time: np.ndarray | None = None,
    ) -> Finding:
        """A finding of this check.

        Args:
            rows: where it shows, None for the whole recording.
            set_aside: samples that are not to be used.
            time: shape (n,), of all samples [s], where it is not what the stamps say.
        """
        span = None if rows is None or not rows.size else subject.span(rows)
        path = subject.recording.path
        return Finding(self.name, path, channel, span, certainty, detail, mend, set_aside, harmful, time)
