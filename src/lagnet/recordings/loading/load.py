"""Reads a recording file of any supported format into a `Recording`, or says in one line why it cannot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.errors import RecordingError
from lagnet.recordings.loading import clock, units
from lagnet.recordings.loading.column_map import ColumnMap, read_column_map
from lagnet.recordings.loading.layout import Header, Layout, find_layout
from lagnet.recordings.loading.opening import READERS, Progress, open_source
from lagnet.recordings.loading.wrapping import beside, unwrap
from lagnet.recordings.readers.logs.log_source import LogSource
from lagnet.recordings.readers.source import RowNames, Table
from lagnet.recordings.recording import Recording
from lagnet.recordings.signals import DRIVE_SIGNALS, DRIVING, OPTIONAL

__all__ = ["READERS", "load_recording", "open_source"]
MIN_SAMPLES = 20  # fewer say nothing about noise, and cannot be filtered or split
FAR_TOO_LARGE = 1e12  # in SI units: beyond any position, speed, torque or current of a joint
FAR_TOO_LATE = 1e19  # [s]: beyond nanoseconds since 1970 that were not scaled
SHORT_MOTION = 5  # samples of one trajectory below which it cannot be differentiated


@dataclass(frozen=True)
class JointFacts:
    """What the caller knows of the joints.

    Args:
        joints: names in model order, or None.
        n_dof: number of joints, or None.
        torque_constant: shape (dof,), [N m/A] or [N/A], or None.
        ranges: limits and kinds of the joints, or None.
    """

    joints: tuple[str, ...] | None
    n_dof: int | None
    torque_constant: np.ndarray | None
    ranges: units.JointRanges | None


def load_recording(
    path: str | Path,
    *,
    robot: Any = None,
    n_dof: int | None = None,
    joints: Sequence[str] | None = None,
    columns: str | Path | ColumnMap | None = None,
    torque_constant: Sequence[float] | np.ndarray | float | None = None,
    limits: np.ndarray | None = None,
    progress: Progress | None = None,
) -> Recording:
    """Read what a robot did: positions, torques or commands, and what else was recorded, all in SI units.

    Args:
        path: table (.csv, .csv.gz, .parquet, .npz, .mat), ROS bag, LeRobot folder or another log: see docs.
        robot: anything with `joints` and `n_dof`, and perhaps `position_lower`, `position_upper` and `joint_types`.
        n_dof: number of joints, where there is no robot; None to take it from the file.
        joints: joint names, where there is no robot; None for the file's names or joint_0, joint_1, ….
        columns: mapping of foreign column names and units, or the TOML file that holds it.
        torque_constant: shape (dof,), [N m/A] or [N/A], turns motor current into joint torque; one number serves all.
        limits: shape (dof, 2), lower and upper position [rad] or [m], in place of the robot's; inf where unlimited.
        progress: told (name, done, expected or None) while a long log is read.

    Returns:
        The recording on the file's own clock; `warnings` tells what was survived.

    Raises:
        RecordingError: one line with file, row or column, what is wrong and what would mend it.
    """
    where = str(path)
    column_map = columns if isinstance(columns, ColumnMap) else read_column_map(columns) if columns else ColumnMap()
    facts = _facts(robot, joints, n_dof, torque_constant, limits, column_map, where)
    source, sha256 = open_source(path, progress)
    layout = find_layout(
        Header(source.names, source.joints, column_map, where, isinstance(source, LogSource)), facts.joints, facts.n_dof
    )
    table = source.read(layout.numbers, layout.trajectory)
    del source  # the file's bytes are needed no more: half of the memory of a long recording
    return _Assembly(table, layout, column_map, facts, where).recording(sha256)


def _facts(
    robot: Any,
    joints: Sequence[str] | None,
    n_dof: int | None,
    torque_constant: Any,
    limits: np.ndarray | None,
    column_map: ColumnMap,
    where: str,
) -> JointFacts:
    names = tuple(robot.joints) if robot is not None else None if joints is None else tuple(joints)
    if n_dof is not None and names is not None and len(names) != n_dof:
        raise RecordingError(f"n_dof = {n_dof} was given with {len(names)} joint names", where=where)
    if n_dof is not None and n_dof < 1:
        raise RecordingError(f"n_dof must be at least 1, not {n_dof}", where=where)
    constants = column_map.torque_constant if torque_constant is None else torque_constant
    ranges = None
    if limits is not None:
        lower, upper = np.asarray(limits, dtype=float).T
        ranges = units.JointRanges(lower, upper, ("unknown",) * lower.size)
    elif robot is not None:
        ranges = _ranges_of(robot)
    return JointFacts(names, n_dof, None if constants is None else np.atleast_1d(np.asarray(constants, float)), ranges)


def _ranges_of(robot: Any) -> units.JointRanges:
    n_dof = len(robot.joints)
    blank = units.unknown_ranges(n_dof)
    lower, upper = getattr(robot, "position_lower", None), getattr(robot, "position_upper", None)
    types = getattr(robot, "joint_types", None)
    return units.JointRanges(
        blank.lower if lower is None else np.asarray(lower, float),
        blank.upper if upper is None else np.asarray(upper, float),
        blank.types if types is None else tuple(types),
    )


@dataclass(frozen=True)
class _Assembly:
    """Turns a table into a recording, check by check."""

    table: Table
    layout: Layout
    column_map: ColumnMap
    facts: JointFacts
    where: str

    def recording(self, sha256: str) -> Recording:
        rows = self.table.rows
        time = self.table.numbers[self.layout.time] * self.column_map.factor("time") + self.column_map.added("time")
        self._refuse_few(time.size)
        layout, gaps_in = self._without_broken_signals()
        self._refuse_not_finite(layout)
        self._refuse_empty_labels()
        motions = clock.motions(self.table.labels, time.size, rows, self.where)
        clock.refuse_backward(time, motions.index, self.table.labels is not None, rows, self.where)
        keep, repeats = clock.first_of_repeats(time, motions.index, rows)
        self._refuse_few(int(keep.sum()))
        kept = slice(None) if keep.all() else keep
        signals = {kind: self._signal(kind)[kept] for kind in layout.signals}
        time, index = time[kept], motions.index[kept]
        self._refuse_far_too_large(time, signals, rows, keep)
        self._refuse_wrong_units(time, index, signals)
        still_there = rows.without(np.flatnonzero(~keep))
        turning = np.array([kind != "prismatic" for kind in self._ranges().types])
        raw = signals["q"]
        signals["q"], wraps = unwrap(raw, index, turning, layout.joints, still_there)
        if "command" in signals:
            signals["command"] = beside(signals["command"], raw, signals["q"])
        tau, no_constants = self._torque(signals)
        short = self._short_motions(index, motions.names)
        warnings = (*self.table.warnings, *layout.warnings, *gaps_in, *no_constants, *repeats, *wraps, *short)
        return Recording(
            time=time,
            q=signals["q"],
            tau=tau,
            joints=layout.joints,
            v=signals.get("v"),
            a=signals.get("a"),
            trajectory=index,
            trajectory_names=motions.names,
            path=self.where,
            sha256=sha256,
            warnings=(
                *warnings,
                *clock.describe_steps(time, index, motions.names, still_there),
            ),
            **{kind: signals.get(kind) for kind in ("current", *DRIVE_SIGNALS)},
        )

    def _without_broken_signals(self) -> tuple[Layout, tuple[str, ...]]:
        """The layout without signals that can be missed and have cells that are no numbers, and what to tell."""
        broken: dict[str, tuple[str, int]] = {}
        driving = [kind for kind in DRIVING if kind in self.layout.signals]
        for kind in set(self.layout.signals) & set(OPTIONAL) - {"v", "a"}:
            for name in self.layout.signals[kind]:
                bad = np.flatnonzero(~np.isfinite(self.table.numbers[name]))
                if bad.size and driving != [kind]:
                    broken.setdefault(kind, (name, int(bad[0])))
        kept = {kind: names for kind, names in self.layout.signals.items() if kind not in broken}
        return replace(self.layout, signals=kept), tuple(
            f"{self.table.rows.of(row)}, column {name}: is not a number: {kind} was not read"
            for kind, (name, row) in sorted(broken.items())
        )

    def _refuse_few(self, n: int) -> None:
        if n < MIN_SAMPLES:
            raise RecordingError(
                f"holds {n} usable sample{'s' * (n != 1)}, at least {MIN_SAMPLES} are needed",
                where=self.where,
                next_step="record a longer motion",
            )

    def _refuse_not_finite(self, layout: Layout) -> None:
        worst: tuple[int, str] | None = None
        numbers = {name: self.table.numbers[name] for name in layout.numbers}
        for name, values in numbers.items():
            bad = np.flatnonzero(~np.isfinite(values))
            if bad.size and (worst is None or bad[0] < worst[0]):
                worst = int(bad[0]), name
        if worst is None:
            return
        row, name = worst
        value = self.table.numbers[name][row]
        what = "is not a number (NaN or an empty cell)" if np.isnan(value) else "is infinite"
        count = sum(int(np.sum(~np.isfinite(values))) for values in numbers.values())
        raise RecordingError(
            f"{self.table.rows.of(row)}, column {name}: {what}"
            + (f" ({count} such cells in all)" if count > 1 else ""),
            where=self.where,
            next_step="remove these samples, or split the recording there with a trajectory column",
        )

    def _refuse_far_too_large(
        self, time: np.ndarray, signals: dict[str, np.ndarray], rows: RowNames, keep: np.ndarray
    ) -> None:
        """Numbers that no joint has, such as what is read from freed memory, are as little numbers as NaN is."""
        for kind, values in {"time": time[:, None], **signals}.items():
            bad = np.argwhere(np.abs(values) > (FAR_TOO_LATE if kind == "time" else FAR_TOO_LARGE))
            if bad.size:
                sample, joint = (int(x) for x in bad[0])
                column = kind if kind == "time" else f"{kind}_{joint}"
                raise RecordingError(
                    f"{rows.of(int(np.flatnonzero(keep)[sample]))}, column {column}: {values[sample, joint]:.4g} is"
                    f" no such quantity" + (f" ({len(bad)} such cells in all)" if len(bad) > 1 else ""),
                    where=self.where,
                    next_step="remove these samples, or split the recording there with a trajectory column",
                )

    def _refuse_empty_labels(self) -> None:
        empty = [] if self.table.labels is None else np.flatnonzero(self.table.labels == "")
        if len(empty):
            raise RecordingError(
                f"{self.table.rows.of(int(empty[0]))}, column {self.layout.trajectory}: empty cell",
                where=self.where,
                next_step="label every sample, or remove the column",
            )

    def _signal(self, kind: str) -> np.ndarray:
        """Shape (n, dof), in SI units (amperes for current)."""
        columns = self.layout.signals[kind]
        scaled = [
            self.table.numbers[name] * self.column_map.factor(kind, i, self.layout.joints[i])
            + self.column_map.added(kind, i, self.layout.joints[i])
            for i, name in enumerate(columns)
        ]
        return np.stack(scaled, axis=1)

    def _ranges(self) -> units.JointRanges:
        n_dof = len(self.layout.joints)
        ranges = self.facts.ranges or units.unknown_ranges(n_dof)
        if ranges.lower.size != n_dof or len(ranges.types) != n_dof:
            raise RecordingError(f"limits are given for {ranges.lower.size} of {n_dof} joints", where=self.where)
        return ranges

    def _refuse_wrong_units(self, time: np.ndarray, index: np.ndarray, signals: dict[str, np.ndarray]) -> None:
        joints = self.layout.joints
        stated = np.array([self.column_map.states_unit("q", i, joint) for i, joint in enumerate(joints)])
        ranges = self._ranges()
        units.refuse_degrees(signals["q"], ranges, joints, stated, self.where)
        if "v" in signals and "v" not in self.column_map.scale:
            units.refuse_degrees_per_second(time, index, signals["q"], signals["v"], joints, self.where)

    def _torque(self, signals: dict[str, np.ndarray]) -> tuple[np.ndarray | None, tuple[str, ...]]:
        """Joint torque, recorded or from motor current, shape (n, dof), [N m] or [N], or None; and what to tell."""
        if "tau" in signals or "current" not in signals:
            return signals.get("tau"), ()
        constants, n_dof = self.facts.torque_constant, len(self.layout.joints)
        if constants is None and "command" in signals:
            return None, ("holds motor current without torque constants: there is no torque, only commands",)
        if constants is None:
            raise RecordingError(
                "holds motor current, which needs a torque constant [N m/A] per joint",
                where=self.where,
                next_step="give a --columns file with [torque_constant] values = [...]"
                f" ({n_dof} number{'s' * (n_dof != 1)}), or torque_constant=[...] in Python",
            )
        if constants.size not in (1, n_dof) or not np.isfinite(constants).all() or (constants == 0).any():
            raise RecordingError(
                f"{constants.size} torque constants were given for {n_dof} joints",
                where=self.where,
                next_step=f"give {n_dof} numbers [N m/A] other than zero, in joint order",
            )
        return signals["current"] * constants, ()

    def _short_motions(self, index: np.ndarray, names: tuple[str, ...]) -> tuple[str, ...]:
        short = np.flatnonzero(np.bincount(index, minlength=len(names)) < SHORT_MOTION)
        if not short.size:
            return ()
        have = "trajectory has" if short.size == 1 else "trajectories have"
        listed = ", ".join(names[k] for k in short[:5]) + (", …" if short.size > 5 else "")
        return (f"{short.size} {have} fewer than {SHORT_MOTION} samples: {listed}",)
