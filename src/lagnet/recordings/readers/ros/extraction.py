"""What each kind of message says of joints: measurements, commands, or both."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from lagnet.recordings.readers.ros.bag_files import Bag, Message, Progress
from lagnet.recordings.readers.ros.definitions import (
    ARRAY,
    CONTROLLER_STATE,
    DEFINITIONS,
    DYNAMIC_STATE,
    JOINT_STATE,
    TRAJECTORY,
)
from lagnet.recordings.readers.ros.streams import Streams

COMMANDED = re.compile(r"(^|[/_])(command|commands|cmd|desired|target|reference|goal|setpoint)s?($|[/_])", re.I)
AS_COMMAND = {"q": "command", "v": "command_velocity", "tau": "command_torque"}
INTERFACES = {"position": "q", "velocity": "v", "effort": "tau", "torque": "tau", "current": "current"}
MAX_TRAJECTORIES = 20_000
MAX_POINTS = 100_000


@dataclass(frozen=True, eq=False)
class PlannedMotion:
    """A JointTrajectory that was sent to a controller.

    Args:
        topic: where; start: when it begins [ns]; joints: names.
        times: shape (k,), of its points after the start [s].
        q, v: shape (k, dof); v is None where the points have positions alone.
        received: when it came [ns].
    """

    topic: str
    start: int
    received: int
    joints: tuple[str, ...]
    times: np.ndarray
    q: np.ndarray
    v: np.ndarray | None


@dataclass
class Gathered:
    """Everything of a bag that concerns joints.

    Args:
        measured, commanded: streams with names; arrays: of Float64MultiArray, which have none.
        planned: trajectories.
    """

    measured: Streams
    commanded: Streams
    arrays: dict[str, tuple[list[int], list[np.ndarray]]] = field(default_factory=dict)
    planned: list[PlannedMotion] = field(default_factory=list)


def gather(bag: Bag, where: str, progress: Progress | None = None) -> Gathered:
    """Read every message that concerns joints once."""
    found = Gathered(Streams(where), Streams(where))
    for message in bag.messages(tuple(DEFINITIONS), progress):
        EXTRACTORS[message.type](message, found)
    return found


def _stamp(content: Any) -> int:
    return int(content.header.stamp.sec) * 1_000_000_000 + int(content.header.stamp.nanosec)


def _sort(message: Message, found: Gathered, names: list[str], signals: dict[str, Any]) -> None:
    """To the commands where the topic is called so, else to the measurements."""
    times = (_stamp(message.content), message.received)
    if COMMANDED.search(message.topic):
        told = {AS_COMMAND[kind]: values for kind, values in signals.items() if kind in AS_COMMAND}
        found.commanded.add(message.topic, times, names, told)
    else:
        found.measured.add(message.topic, times, names, signals)


def _joint_state(message: Message, found: Gathered) -> None:
    content = message.content
    if content.name:
        _sort(message, found, content.name, {"q": content.position, "v": content.velocity, "tau": content.effort})


def _dynamic_state(message: Message, found: Gathered) -> None:
    content = message.content
    signals = {kind: np.full(len(content.joint_names), np.nan) for kind in ("q", "v", "tau", "current")}
    for j, interfaces in enumerate(content.interface_values[: len(content.joint_names)]):
        for name, value in zip(interfaces.interface_names, interfaces.values, strict=False):
            if name in INTERFACES:
                signals[INTERFACES[name]][j] = value
    if content.joint_names:
        _sort(message, found, content.joint_names, signals)


def _controller_state(message: Message, found: Gathered) -> None:
    content, times = message.content, (_stamp(message.content), message.received)
    is_now, was_told = _point(content, "feedback", "actual"), _point(content, "reference", "desired")
    names = list(content.joint_names)
    if not names:
        return
    if is_now is not None:
        signals = {"q": is_now.positions, "v": is_now.velocities, "tau": is_now.effort}
        found.measured.add(message.topic, times, names, signals)
    if was_told is not None:
        told = {"command": was_told.positions, "command_velocity": was_told.velocities}
        found.commanded.add(message.topic, times, names, told | {"command_torque": was_told.effort})


def _point(content: Any, *names: str) -> Any:
    """The first of these points that is there and filled."""
    found = [getattr(content, name) for name in names if hasattr(content, name)]
    return next((point for point in found if len(point.positions) or len(point.velocities)), None)


def _trajectory(message: Message, found: Gathered) -> None:
    content = message.content
    n, points = len(content.joint_names), content.points
    if not n or not points or len(found.planned) >= MAX_TRAJECTORIES or len(points) > MAX_POINTS:
        return
    if any(len(point.positions) != n for point in points):
        return
    after = np.array([p.time_from_start.sec + 1e-9 * p.time_from_start.nanosec for p in points])
    q = np.array([p.positions for p in points], dtype=np.float64)
    fast = all(len(p.velocities) == n for p in points)
    v = np.array([p.velocities for p in points], dtype=np.float64) if fast else None
    start = _stamp(content)  # zero means: at once
    motion = PlannedMotion(message.topic, start, message.received, tuple(content.joint_names), after, q, v)
    found.planned.append(motion)


def _array(message: Message, found: Gathered) -> None:
    stamps, rows = found.arrays.setdefault(message.topic, ([], []))
    row = np.asarray(message.content.data, dtype=np.float64)
    if not rows or row.size == rows[0].size:
        stamps.append(message.received)
        rows.append(row)


EXTRACTORS = {
    JOINT_STATE: _joint_state,
    DYNAMIC_STATE: _dynamic_state,
    CONTROLLER_STATE: _controller_state,
    TRAJECTORY: _trajectory,
    ARRAY: _array,
}
