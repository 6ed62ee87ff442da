"""Which of a file's columns hold which signal of which joint."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

from lagnet.errors import RecordingError, closest
from lagnet.recordings.loading.column_map import ColumnMap
from lagnet.recordings.loading.joint_match import JointMatch, match_joints
from lagnet.recordings.signals import DRIVE_SIGNALS, DRIVING, JOINT_SIGNALS, UNITS

NUMBERED = re.compile(rf"({'|'.join(JOINT_SIGNALS)})_(\d+)")
MAX_JOINTS = 64
NOT_THERE = ""  # what a mapping gives for a signal that is not to be read


@dataclass(frozen=True)
class Layout:
    """Names of the file's columns, by signal.

    Args:
        joints: joint names in model order.
        time: name of the time column.
        signals: kind (q, v, tau, command, …) to the columns of its joints in model order; absent kinds are left out.
        trajectory: name of the label column, or None.
        warnings: what was noticed and survived.
    """

    joints: tuple[str, ...]
    time: str
    signals: dict[str, tuple[str, ...]]
    trajectory: str | None
    warnings: tuple[str, ...] = ()

    @property
    def numbers(self) -> list[str]:
        """All columns of numbers, each once."""
        return list(dict.fromkeys([self.time, *(name for names in self.signals.values() for name in names)]))


@dataclass(frozen=True)
class Header:
    """A file's column names and the mapping to read them by.

    Args:
        names: column names in file order.
        joints: joint names that the file states for its numbered columns, or None.
        column_map: the user's mapping.
        where: the file.
        log: whether it is a log of a whole robot, which may hold joints that the model does not have.
        match: where the robot's joints stand among those that the file states, or None.
    """

    names: tuple[str, ...]
    joints: tuple[str, ...] | None
    column_map: ColumnMap
    where: str
    log: bool = False
    match: JointMatch | None = None

    def error(self, what: str, next_step: str | None = None) -> RecordingError:
        """An error of this file."""
        return RecordingError(what, where=self.where, next_step=next_step)


def find_layout(header: Header, joints: Sequence[str] | None, n_dof: int | None) -> Layout:
    """Match the file's columns to the joints.

    Args:
        header: the file's columns.
        joints: names in model order, or None to take them from the file.
        n_dof: number of joints where no names are known, or None.

    Raises:
        RecordingError: missing or doubled columns, or another number of joints than asked for.
    """
    if not header.column_map.columns and all(name.startswith("column_") for name in header.names):
        raise header.error(
            "has no header line", "add one (time,q_0,…,tau_0,…) or map column_0, column_1, … in a --columns file"
        )
    names = tuple(joints) if joints is not None else _joints_of_file(header, n_dof)
    if joints is not None and header.joints is not None:
        match = match_joints(header.joints, names)
        header = replace(header, match=match if header.log or not match.unused else None)
    if joints is not None or n_dof is not None:
        _refuse_other_joint_count(header, names)
    time = _time(header)
    signals = {kind: found for kind in JOINT_SIGNALS if (found := _signal(header, kind, names))}
    if "q" not in signals:
        raise _missing(header, "q", names, names)
    warnings = [*_told_of_match(header, names), *_told_of_unused(header)]
    if "tau" in signals and "current" in signals:
        warnings.append("holds torque and current: the torque is used")
    if not signals.keys() & set(DRIVING):
        raise header.error(
            f"has neither torque ({_example('tau', names)}) nor motor current ({_example('current', names)})"
            f" nor commanded positions ({_example('command', names)})",
            "name these columns so, or map the file's own names in a --columns file" + _seen(header),
        )
    trajectory = header.column_map.columns.get("trajectory", "trajectory")
    if "trajectory" in header.column_map.columns and trajectory not in header.names:
        raise _unmapped(header, "trajectory", trajectory)
    layout = Layout(names, time, signals, trajectory if trajectory in header.names else None, tuple(warnings))
    _refuse_doubled(header, layout)
    return layout


def _joints_of_file(header: Header, n_dof: int | None) -> tuple[str, ...]:
    """Joint names, or joint_0, joint_1, … for numbered columns."""
    if n_dof is not None:
        return _default_joints(n_dof)
    mapped = _mapped_joints(header)
    numbers = [int(match[2]) for name in header.names if (match := NUMBERED.fullmatch(name)) and match[1] == "q"]
    numbers += [int(match[2]) for name in mapped if (match := NUMBERED.fullmatch(f"q_{name}"))]
    if numbers:
        count = max(numbers) + 1
        if count > MAX_JOINTS:
            raise header.error(f"has a column q_{count - 1}: more than {MAX_JOINTS} joints are not supported")
        stated = header.joints is not None and len(header.joints) == count
        return header.joints if stated and header.joints is not None else _default_joints(count)
    named = [name[2:] for name in header.names if name.startswith("q_") and len(name) > 2] or list(mapped)
    if not named and "q" in header.column_map.columns:
        return _default_joints(_count_pattern(header))
    if not named:
        raise header.error(
            "has no position column (q_0, q_1, …)",
            "name them so or map the file's names with --columns" + _seen(header),
        )
    return tuple(dict.fromkeys(named))


def _mapped_joints(header: Header) -> tuple[str, ...]:
    return tuple(name[2:] for name in header.column_map.columns if name.startswith("q_"))


def _count_pattern(header: Header) -> int:
    count = 0
    while count < MAX_JOINTS and header.column_map.file_name("q", count, f"joint_{count}") in header.names:
        count += 1
    return max(count, 1)


def _default_joints(n_dof: int) -> tuple[str, ...]:
    return tuple(f"joint_{i}" for i in range(n_dof))


def _refuse_other_joint_count(header: Header, joints: tuple[str, ...]) -> None:
    if any(name == "q" or name.startswith("q_") for name in header.column_map.columns):
        return
    if all(f"q_{joint}" in header.names for joint in joints):
        return
    if header.match is not None and header.match.complete:
        return
    if header.match is not None and header.joints is not None:
        _refuse_match(header, header.match, joints)
    numbers = [int(match[2]) for name in header.names if (match := NUMBERED.fullmatch(name))]
    count = max(numbers, default=-1) + 1
    if count and count != len(joints):
        listed = ", ".join(joints[:8]) + (", …" if len(joints) > 8 else "")
        raise header.error(
            f"has columns of {count} joint{'s' * (count != 1)} ({_example('q', ('',) * count)}), the robot has"
            f" {len(joints)} ({listed})",
            "give the recording of this robot, or map the columns of its joints with --columns"
            + "".join(f"; {_can_be_held(joint)}" for joint in joints[count : count + 1]),
        )


def _time(header: Header) -> str:
    mapped = header.column_map.columns.get("time")
    if mapped is not None and mapped not in header.names:
        raise _unmapped(header, "time", mapped)
    for name in (mapped, "time", "t"):
        if name is not None and name in header.names:
            return name
    raise header.error("column time is missing", 'name it time [s], or map it: "time" = "timestamp"' + _seen(header))


def _signal(header: Header, kind: str, joints: tuple[str, ...]) -> tuple[str, ...]:
    """The columns of one kind in model order; () where the file has none of them."""
    found = [_column(header, kind, i, joint, joints) for i, joint in enumerate(joints)]
    if not any(found) or (kind in DRIVE_SIGNALS and kind not in DRIVING and not all(found)):
        return ()
    if None in found:
        raise _missing(
            header, kind, tuple(joint for joint, name in zip(joints, found, strict=True) if name is None), joints
        )
    return tuple(name for name in found if name is not None)


def _column(header: Header, kind: str, index: int, joint: str, joints: tuple[str, ...]) -> str | None:
    mapped = header.column_map.file_name(kind, index, joint)
    if mapped is not None:
        if mapped == NOT_THERE:
            return None
        if mapped not in header.names:
            raise _unmapped(header, f"{kind}_{index}", mapped)
        return mapped
    by_name, by_number = f"{kind}_{joint}", f"{kind}_{_file_index(header, index, joint, joints)}"
    has_name, has_number = by_name in header.names, by_number in header.names
    if joint.isdigit() and by_name != by_number:
        # Joints called "1" … "7" beside columns q_0 … q_6: numbers mean indices if the file counts from 0.
        has_name = has_name and f"{kind}_0" not in header.names
        has_number = has_number and not has_name and f"{kind}_0" in header.names
    if has_name and has_number and by_name != by_number:
        raise header.error(f"{by_name} and {by_number} both give joint {joint}", "remove one of the two columns")
    return by_name if has_name else by_number if has_number else None


def _file_index(header: Header, index: int, joint: str, joints: tuple[str, ...]) -> int:
    """Position of a joint in the file, where the file states the order of its own joints."""
    found = None if header.match is None else header.match.index[index]
    return index if found is None else found


def _refuse_match(header: Header, match: JointMatch, joints: tuple[str, ...]) -> None:
    """Stop where the file names its joints and they are not those of the robot."""
    if match.ambiguous:
        raise header.error(
            f"the joints of the robot fit {len(match.ambiguous)} sets of joints: {', '.join(match.ambiguous[:4])}",
            "say which by a --columns file, which `lagnet data inspect` writes",
        )
    named = ", ".join((header.joints or ())[:8])
    if match.how == "name":
        lacking = [joint for joint, found in zip(joints, match.index, strict=True) if found is None]
        raise header.error(f"has no joint {', '.join(lacking[:6])}: it names {named}", _can_be_held(lacking[0]))


def _told_of_match(header: Header, joints: tuple[str, ...]) -> list[str]:
    match = header.match
    if match is None or match.how in ("", "name") or header.joints is None:
        return []
    pairs = ", ".join(f"{header.joints[i]} = {j}" for i, j in zip(match.index, joints, strict=True) if i is not None)
    return [f"joints were matched by {match.how}: {pairs}"]


def _told_of_unused(header: Header) -> list[str]:
    unused = () if header.match is None else header.match.unused
    listed = ", ".join(unused[:6]) + (", …" if len(unused) > 6 else "")
    return [f"the robot has no joint {listed}: not read; it should stand still"] if unused else []


def _refuse_doubled(header: Header, layout: Layout) -> None:
    counts = Counter(header.names)
    wanted = [*layout.numbers, *([layout.trajectory] if layout.trajectory else [])]
    for name in wanted:
        if counts[name] > 1:
            raise header.error(
                f"column {name} stands {counts[name]} times in the header", "remove or rename all but one"
            )
    used = [layout.time, *(name for names in layout.signals.values() for name in names)]
    for name, times in Counter(used).items():
        if times > 1:
            raise header.error(f"column {name} is mapped to {times} signals", "give each signal its own column")


def _missing(header: Header, kind: str, lacking: Sequence[str], order: tuple[str, ...]) -> RecordingError:
    told = ", ".join(f"{kind}_{order.index(joint)} (or {kind}_{joint})" for joint in lacking[:3])
    more = f" and {len(lacking) - 3} more" if len(lacking) > 3 else ""
    near = closest(f"{kind}_{order.index(lacking[0])}", [n for n in header.names if not NUMBERED.fullmatch(n)])
    hint = f"; is {near} meant?" if near else ""
    be = "is" if len(lacking) == 1 else "are"
    ending = f"add the column [{UNITS[kind]}] or map the file's own name with --columns"
    if kind == "q" and len(lacking) < len(order):
        ending += f"; {_can_be_held(lacking[0])}"
    if kind in ("v", "a"):
        ending += f", or leave out all {kind} columns: they are derived from q"
    return header.error(f"column {told}{more} {be} missing{hint}", ending)


def _can_be_held(joint: str) -> str:
    return f"joints that stood still, like fingers, can be held: --hold {joint}=0"


def _unmapped(header: Header, ours: str, theirs: str) -> RecordingError:
    near = closest(theirs, header.names)
    return header.error(
        f"column {theirs!r}, which {header.column_map.path} gives as {ours}, is not in the file",
        f"did you mean {near!r}?" if near else "correct the mapping" + _seen(header),
    )


def _example(kind: str, joints: tuple[str, ...]) -> str:
    return f"{kind}_0" + (f" … {kind}_{len(joints) - 1}" if len(joints) > 1 else "")


def _seen(header: Header) -> str:
    shown = ", ".join(header.names[:12]) + (", …" if len(header.names) > 12 else "")
    return f" (the file has: {shown[:300]})"
