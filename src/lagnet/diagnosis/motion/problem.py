"""u(t), q(t) and the nominal load of every joint: the data of a diagnosis on motion, and its windows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from lagnet.diagnosis.motion.recorded_duty import DutyLine, duty_line
from lagnet.diagnosis.motion.sharpened_rates import sharpened_rates
from lagnet.diagnosis.motion.smoothing import SMOOTHING, motion_rates
from lagnet.errors import DiagnosisError
from lagnet.recordings.recording import Recording
from lagnet.recordings.sampling import median_step
from lagnet.rigid_body.kinematic_tree import KinematicTree
from lagnet.rollout.measured_load import measured_load
from lagnet.rollout.one_joint import JointSeries, Windows
from lagnet.rollout.whole_arm import roll_out_arm
from lagnet.servos.command_delay import command_integral

ROLLED = 0.004  # [s] longest step of a rollout of the nominal servos
SLOPES = 0.1  # [s] between poses at which the derivative of the load is computed
WINDOW = (2.0, 4.0)  # [s] least and greatest length of a rollout from measured positions
WINDOWS = 60  # that there should be at least
REACH = 0.3  # of a window, by which its start may move to where its state is surer


@dataclass(frozen=True, eq=False)
class Run:
    """One trajectory of one recording: rows `first` to `last` of the problem's arrays."""

    recording: int
    first: int
    last: int


@dataclass(frozen=True, eq=False)
class MotionProblem:
    """Recorded motion of all joints on the recordings' own clocks.

    Args:
        joints: joint names in model order.
        tree: the nominal bodies.
        series: command, position and load of each joint.
        runs: the trajectories, one after the other.
        speed: shape (n, dof), smoothed measured speed [rad/s].
        start_speed: shape (runs, dof), speed at the first sample of each run: zero, but for one that continues another.
        step: longest step of integration [s].
        greatest_duty: shape (dof,), of all recordings, 1 for the full supply; nan where none was recorded.
        duty_lines: of each joint the controller as its recorded duty shows it, None where it does not.
    """

    joints: tuple[str, ...]
    tree: KinematicTree
    series: tuple[JointSeries, ...]
    runs: tuple[Run, ...]
    speed: np.ndarray
    start_speed: np.ndarray
    step: float
    greatest_duty: np.ndarray
    duty_lines: tuple[DutyLine | None, ...]

    @property
    def duration(self) -> float:
        """Recorded time of all trajectories [s]."""
        time = self.series[0].time
        return float(sum(time[run.last] - time[run.first] for run in self.runs))

    def windows(self, joint: int, length: float | None = None) -> Windows:
        """Windows of about `length` seconds from a joint's measured position and speed; None: shorter for short ones.

        They start where that state is surest, see `surest_edges`.
        """
        length = length or float(np.clip(self.duration / WINDOWS, *WINDOW))
        time, rows = self.series[joint].time, []
        for run in self.runs:
            count = max(1, round((time[run.last] - time[run.first]) / length))
            edges = surest_edges(self.speed[run.first : run.last + 1, joint], count) + run.first
            rows += [(a, b, run.first) for a, b in pairwise(edges) if b > a]
        first, last, floor = (np.array(column) for column in zip(*rows, strict=True))
        speed = self.speed[first, joint]
        for run, begun in zip(self.runs, self.start_speed[:, joint], strict=True):
            speed[first == run.first] = begun
        return Windows(first, last, floor, speed)


def surest_edges(speed: np.ndarray, count: int) -> np.ndarray:
    """First, inner and last samples of `count` stretches, shape (count + 1,), each inner one where |dv/dt| is least.

    A speed smoothed over `SMOOTHING` seconds is wrong where it changes within them: before a joint that sticks breaks
    away it is not zero, and a rollout from there starts to slip at once. At rest and in even motion it is right.

    Args:
        speed: shape (n,) or (n, joints), smoothed speeds of a trajectory.
        count: number of stretches; edges move by up to `REACH` of a stretch.
    """
    last = len(speed) - 1
    edges, change = np.linspace(0, last, count + 1), np.abs(np.gradient(speed, axis=0))
    change = change if change.ndim == 1 else change.max(axis=1)
    reach = int(REACH * last / count)
    out = [0]
    for edge in edges[1:-1].astype(int):
        near = np.arange(max(0, edge - reach), min(last, edge + reach) + 1)
        near = near[np.argsort(np.abs(near - edge), kind="stable")]  # of equal ones the nearest
        out.append(int(near[np.argmin(change[near])]))
    return np.array([*out, last])


def pose_motion_problem(
    recordings: Sequence[Recording],
    tree: KinematicTree,
    gains: Sequence[float] | None = None,
    voltage: float = 0.0,
    continued: int = 0,
    laws: np.ndarray | None = None,
) -> MotionProblem:
    """Commands, motion and nominal loads of recordings, joint by joint.

    Args:
        recordings: with commands, joints as the tree's.
        tree: the nominal bodies.
        gains: gains of the controller in each recording over those of the law, 1 where None.
        voltage: nominal supply [V]; 0: the median of what was recorded.
        continued: so many recordings at the end may be the last stretches of as many at the beginning.
        laws: shape (dof, len(LAW)), of nominal servos, whose rollouts sharpen speed and acceleration; None: not known.

    Raises:
        DiagnosisError: a recording without commands, fewer than ten samples in every trajectory, or gains that are not
            one positive number a recording.
    """
    if gains is not None and (len(gains) != len(recordings) or not all(0.0 < g < np.inf for g in gains)):
        step = f"give {len(recordings)} positive numbers, one a recording in their order"
        raise DiagnosisError(f"the gains {', '.join(f'{g:g}' for g in gains)} do not fit", next_step=step)
    parts = [(i, part) for i, recording in enumerate(recordings) for part in recording.parts() if len(part) >= 10]
    if not parts:
        raise DiagnosisError("no trajectory has ten samples", next_step="give longer recordings")
    voltage = voltage or median_voltage(recordings)
    start = np.array([start_speed(part, _before(recordings, i, continued)) for i, part in parts])
    blocks = [
        _block(part, tree, 1.0 if gains is None else gains[i], voltage, laws, v0)
        for (i, part), v0 in zip(parts, start, strict=True)
    ]
    sizes = np.cumsum([0, *(len(part) for _, part in parts)])
    runs = tuple(Run(i, int(sizes[k]), int(sizes[k + 1]) - 1) for k, (i, _) in enumerate(parts))
    rows = {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}
    names = tuple(JointSeries.__dataclass_fields__)
    series = tuple(
        JointSeries(*(np.ascontiguousarray(rows[n] if n == "time" else rows[n][:, j]) for n in names))
        for j in range(parts[0][1].n_dof)
    )
    step = float(np.clip(median_step(parts[0][1].time), 0.001, 0.005))
    lines = tuple(duty_line(recordings, gains, j) for j in range(len(series)))
    return MotionProblem(
        recordings[0].joints, tree, series, runs, rows["speed"], start, step, greatest_duty(recordings), lines
    )


def greatest_duty(recordings: Sequence[Recording]) -> np.ndarray:
    """max |duty| of every joint, shape (dof,); nan where a recording has none."""
    found = [np.full(r.n_dof, np.nan) if r.duty is None else np.abs(r.duty).max(axis=0) for r in recordings]
    return np.max(found, axis=0)


def _before(recordings: Sequence[Recording], index: int, continued: int) -> Recording | None:
    """The recording that one of the last `continued` may continue."""
    first = len(recordings) - continued
    return recordings[index - first] if continued and index >= first else None


def start_speed(part: Recording, before: Recording | None) -> np.ndarray:
    """v at the first sample, shape (dof,): zero, but where the samples of another recording end just before it.

    A motion that is cut in two goes on at the cut; smoothed over both sides, its speed is known there.
    """
    gap = np.inf if before is None else float(part.time[0] - before.time[-1])
    sample = median_step(part.time)
    if before is None or not 0.0 < gap < 2.0 * sample:
        return np.zeros(part.n_dof)
    count = max(5, round(SMOOTHING / sample))
    time = np.concatenate([before.time[-count:], part.time[:count]])
    q = np.concatenate([before.q[-count:], part.q[:count]])
    return motion_rates(time, q)[0][min(count, len(before))]


def median_voltage(recordings: Sequence[Recording]) -> float:
    """Median of the recorded supply [V]; 0 where none was recorded."""
    found = [r.voltage[np.isfinite(r.voltage)] for r in recordings if r.voltage is not None]
    return float(np.median(np.concatenate(found))) if found else 0.0


def _block(
    part: Recording, tree: KinematicTree, gain: float, voltage: float, laws: np.ndarray | None, v0: np.ndarray
) -> dict[str, np.ndarray]:
    """The columns of one trajectory, each of shape (n, dof) beside `time`."""
    if part.command is None:
        raise DiagnosisError(
            "holds no commands", where=part.path or None, next_step="record command_i, or diagnose on torque"
        )
    command, q = np.array(part.command), np.array(part.q)
    ones = np.ones_like(q)
    signals = {
        "ratio": ones if part.voltage is None or not voltage else np.array(part.voltage) / voltage,
        "gain": gain * ones,
        "enabled": ones if part.enabled is None else np.array(part.enabled, dtype=float),
    }
    if laws is None:
        speed, acceleration = motion_rates(part.time, q)
    else:
        predicted = roll_out_arm(tree, laws, part.time, command, q[0], v0=v0, step=ROLLED, **signals)
        speed, acceleration = sharpened_rates(part.time, q, predicted)
    stride = max(1, int(SLOPES / median_step(part.time)))
    mass, load, slope = measured_load(tree, q, speed, acceleration, stride)
    return {
        "time": np.array(part.time),
        "command": command,
        "integral": command_integral(part.time, command),
        "q": q,
        "mass": mass,
        "load": load,
        "load_slope": slope,
        "speed": speed,
    } | signals


def is_a_servo_recording(recording: Any) -> bool:
    """Whether a recording says how its joints were commanded, and no torque."""
    return recording.command is not None and recording.tau is None and recording.current is None
