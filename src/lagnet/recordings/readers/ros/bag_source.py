"""ROS bags as recordings: joint states, and the commands that were sent, on the clock of the joint states."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from lagnet.errors import RecordingError
from lagnet.recordings.readers.logs.log_source import LogSource, Origin, from_first_command, held, per_joint
from lagnet.recordings.readers.ros.bag_files import MCAP, ROS1, SQLITE, Bag, Progress, head_of
from lagnet.recordings.readers.ros.commands import array_commands, planned_commands
from lagnet.recordings.readers.ros.extraction import Gathered, gather
from lagnet.recordings.readers.ros.streams import Arrays

NAMES = {SQLITE: "rosbag2 (sqlite)", MCAP: "rosbag2 (MCAP)", ROS1: "ROS 1 bag", None: "rosbag2 (folder)"}
EVIDENCE = {
    SQLITE: "SQLite file with the tables topics and messages",
    MCAP: "begins with the MCAP magic bytes",
    ROS1: "begins with '#ROSBAG V2.0'",
    None: "folder with bag files",
}


def open_bag(path: Path, where: str, progress: Progress | None = None) -> LogSource:
    """Read the joint signals of a bag.

    Raises:
        RecordingError: a damaged bag, or one without joint states.
        MissingExtraError: rosbags is not installed.
    """
    bag = Bag(path)
    try:
        found = gather(bag, where, progress)
        topics = bag.topics
    finally:
        bag.close()
    measured = found.measured.arrays()
    states = [stream for stream in measured if stream.holds("q")]
    if not states:
        seen = ", ".join(f"{t} ({k})" for t, k in sorted(topics.items())[:8]) or "no topic"
        raise RecordingError(
            f"has no joint states: it holds {seen}",
            where=where,
            next_step="record a topic of sensor_msgs/JointState, DynamicJointState or a controller's state",
        )
    table = _Joined(found)
    table.add_states(states)
    table.add_commands()
    columns = {"time": (table.base.stamps - table.base.stamps[0]) * 1e-9} | table.columns
    columns, _, cut = from_first_command(columns)
    magic = head_of(path) if path.is_file() else None
    stamped = "times of arrival of" if table.base.by_arrival else "header stamps of"
    effort = f"the field effort of {table.base.topic}" if any(n.startswith("tau_") for n in columns) else ""
    origin = Origin(NAMES[magic], EVIDENCE[magic], f"{stamped} {table.base.topic}", True, effort)
    told = (*table.told, *cut)
    return LogSource(origin, columns, table.joints, where, warnings=tuple(dict.fromkeys(told)))


@dataclass
class _Joined:
    """Streams put on the clock of the largest one."""

    found: Gathered
    joints: tuple[str, ...] = ()
    columns: dict[str, np.ndarray] = field(default_factory=dict)
    told: list[str] = field(default_factory=list)
    base: Arrays = field(init=False)

    def add_states(self, states: list[Arrays]) -> None:
        """Joints of every stream, each joint from the stream that says most of it."""
        ranked = sorted(states, key=_says, reverse=True)
        self.base = ranked[0]
        if self.base.by_arrival:
            self.told.append(f"{self.base.topic} has no header stamps: times of arrival were used")
        if self.base.late:
            self.told.append(
                f"{self.base.late} messages on {self.base.topic} came late and were sorted by their stamps"
            )
        for stream in ranked:
            fresh = [j for j in stream.joints if j not in self.joints]
            if not fresh:
                if stream.topic != self.base.topic:
                    self.told.append(f"{stream.topic} repeats joints of {self.base.topic} and was not read")
                continue
            self._add_joints(stream, fresh)

    def _add_joints(self, stream: Arrays, fresh: list[str]) -> None:
        pick = [stream.joints.index(joint) for joint in fresh]
        same_clock = stream is self.base
        if not same_clock:
            self.told.append(
                f"joints {', '.join(fresh[:6])} come from other messages ({stream.topic}): interpolated to the clock"
            )
        for kind, values in stream.signals.items():
            wanted = values[:, pick]
            there = wanted if same_clock else _interpolated(stream.stamps, wanted, self.base.stamps)
            numbered = per_joint(kind, there)
            shift = len(self.joints)
            self.columns |= {_renumbered(name, shift): column for name, column in numbered.items()}
        self.joints += tuple(fresh)

    def add_commands(self) -> None:
        """Commands from streams with names first, then from trajectories, then from arrays without names."""
        full = self._base_of_all()
        self._add_named(full)
        if not self._has("command") and self.found.planned:
            q, v = planned_commands(self.found.planned, full)
            self._put("command", q)
            self._put("command_velocity", v)
            n = len(self.found.planned)
            self.told.append(
                f"commands were interpolated between the points of {n} trajector{'y' if n == 1 else 'ies'}"
            )
        for topic, (stamps, rows) in self.found.arrays.items():
            signals, said = array_commands(topic, np.array(stamps, dtype=np.int64), np.array(rows), self.base)
            fresh = {kind: values for kind, values in signals.items() if not self._has(kind)}
            self.told.append(said)
            for kind, values in fresh.items():
                self._put(kind, values)

    def _add_named(self, full: Arrays) -> None:
        for stream in sorted(self.found.commanded.arrays(), key=_says, reverse=True):
            offset = int(np.median(full.stamps - full.received)) if stream.by_arrival else 0
            for kind in stream.signals:
                if not stream.holds(kind):
                    continue
                at_samples = held(stream.stamps + offset, stream.signals[kind], full.stamps)
                values = np.full((full.stamps.size, len(self.joints)), np.nan)
                known = [(k, self.joints.index(j)) for k, j in enumerate(stream.joints) if j in self.joints]
                for k, j in known:
                    values[:, j] = at_samples[:, k]
                self._put(kind, values)

    def _base_of_all(self) -> Arrays:
        """The base clock with the positions of all joints."""
        n = self.base.stamps.size
        q = np.stack([self.columns.get(f"q_{j}", np.full(n, np.nan)) for j in range(len(self.joints))], axis=1)
        base = self.base
        return Arrays(base.topic, self.joints, base.stamps, base.received, {"q": q}, base.by_arrival, base.late)

    def _has(self, kind: str) -> bool:
        return any(f"{kind}_{j}" in self.columns for j in range(len(self.joints)))

    def _put(self, kind: str, values: np.ndarray) -> None:
        for name, column in per_joint(kind, values).items():
            self.columns.setdefault(name, column)


def _says(stream: Arrays) -> tuple[int, int, int]:
    """How much a stream says: joints, kinds of signals, samples."""
    return len(stream.joints), sum(stream.holds(kind) for kind in stream.signals), stream.stamps.size


def _renumbered(name: str, shift: int) -> str:
    kind, number = name.rsplit("_", 1)
    return f"{kind}_{int(number) + shift}"


def _interpolated(stamps: np.ndarray, values: np.ndarray, at: np.ndarray) -> np.ndarray:
    clock, wanted = (stamps - stamps[0]) * 1e-9, (at - stamps[0]) * 1e-9
    return np.stack([np.interp(wanted, clock, column) for column in values.T], axis=1)
