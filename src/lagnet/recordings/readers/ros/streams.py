"""Joint signals of a bag gathered message by message, by topic and publisher, in the order of their stamps."""

from __future__ import annotations

from array import array
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from lagnet.errors import RecordingError
from lagnet.recordings.readers.source import MAX_BYTES, SPLIT_IT

MAX_STREAMS = 64  # different sets of joints; more is no robot


@dataclass
class Stream:
    """Samples of one set of joints on one topic.

    Args:
        topic: where they were published.
        joints: names, in the order of the first message.
        kinds: signals gathered, e.g. ("q", "v", "tau").
    """

    topic: str
    joints: tuple[str, ...]
    kinds: tuple[str, ...]
    stamps: array = field(default_factory=lambda: array("q"))
    received: array = field(default_factory=lambda: array("q"))
    rows: array = field(default_factory=lambda: array("d"))

    def add(self, stamp: int, received: int, names: Sequence[str], signals: Mapping[str, Sequence[float]]) -> None:
        """Append one message, its joints in whatever order they came.

        Args:
            stamp, received: header stamp and time of arrival [ns].
            names: joint names of the message.
            signals: kind to values in the order of `names`; empty or short where the publisher has none.
        """
        order = range(len(names)) if tuple(names) == self.joints else [names.index(joint) for joint in self.joints]
        self.stamps.append(stamp)
        self.received.append(received)
        for kind in self.kinds:
            values = signals.get(kind, ())
            size = len(values)
            self.rows.extend([float(values[k]) if k < size else np.nan for k in order])

    def arrays(self) -> Arrays:
        """Everything gathered, sorted by stamp."""
        shape = (len(self.stamps), len(self.kinds), len(self.joints))
        values = np.frombuffer(self.rows, dtype=np.float64).reshape(shape)
        stamps = np.frombuffer(self.stamps, dtype=np.int64)
        received = np.frombuffer(self.received, dtype=np.int64)
        made_of_arrival = np.unique(stamps).size < 0.5 * stamps.size + 1
        clock = received if made_of_arrival else stamps
        order = np.argsort(clock, kind="stable")
        late = int(np.sum(np.diff(clock) < 0))
        if late:
            clock, received, values = clock[order], received[order], values[order]
        signals = {kind: values[:, k] for k, kind in enumerate(self.kinds)}
        return Arrays(self.topic, self.joints, clock, received, signals, made_of_arrival, late)


@dataclass(frozen=True, eq=False)
class Arrays:
    """A stream as arrays.

    Args:
        topic, joints: of the stream.
        stamps, received: shape (n,), [ns].
        signals: kind to values of shape (n, dof), NaN where the publisher has none.
        by_arrival: whether header stamps were empty, so that `stamps` are times of arrival.
        late: messages that came after a younger one.
    """

    topic: str
    joints: tuple[str, ...]
    stamps: np.ndarray
    received: np.ndarray
    signals: dict[str, np.ndarray]
    by_arrival: bool
    late: int

    def holds(self, kind: str) -> bool:
        """Whether any number of that kind was published."""
        return kind in self.signals and bool(np.isfinite(self.signals[kind]).any())


class Streams:
    """All streams of a bag."""

    def __init__(self, where: str):
        self._where, self._found, self._bytes = where, {}, 0

    def add(
        self, topic: str, times: tuple[int, int], names: Sequence[str], signals: Mapping[str, Any], check: bool = True
    ) -> None:
        """Append one message to the stream of its topic and joints.

        Raises:
            RecordingError: more joints, streams or samples than any robot has.
        """
        names = list(names)
        key = (topic, frozenset(names))
        stream = self._found.get(key)
        if stream is None:
            if len(self._found) >= MAX_STREAMS:
                raise RecordingError(f"publishes more than {MAX_STREAMS} different sets of joints", where=self._where)
            stream = self._found[key] = Stream(topic, tuple(dict.fromkeys(names)), tuple(signals))
        stream.add(*times, names, signals)
        self._bytes += 8 * (2 + len(stream.kinds) * len(stream.joints))
        if self._bytes > MAX_BYTES / 2:
            raise RecordingError(
                f"holds more than {MAX_BYTES / 2 / 1024**3:g} GiB of joint signals",
                where=self._where,
                next_step=SPLIT_IT,
            )

    def arrays(self) -> list[Arrays]:
        """Every stream, those of most joints and samples first."""
        found = [stream.arrays() for stream in self._found.values()]
        return sorted(found, key=lambda a: (len(a.joints), a.stamps.size), reverse=True)
