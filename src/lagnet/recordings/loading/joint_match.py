"""Which of a log's joints are the robot's: by name, by name without a prefix, else by order."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class JointMatch:
    """Where the robot's joints stand in a log.

    Args:
        index: for each joint of the robot its number in the log; None where it is not there.
        how: "name", "name without prefix", "order", or "" where nothing fits.
        unused: joints of the log that the robot does not have.
        ambiguous: sets of names that fit equally well.
    """

    index: tuple[int | None, ...]
    how: str
    unused: tuple[str, ...] = ()
    ambiguous: tuple[str, ...] = ()

    @property
    def complete(self) -> bool:
        """Whether every joint of the robot was found."""
        return bool(self.how) and None not in self.index


def match_joints(log: Sequence[str], robot: Sequence[str]) -> JointMatch:
    """Find the robot's joints among those of a log.

    Names are compared as they are, then without case, signs and the ending `joint`, then without what all names of
    either side begin with (`left_joint1` and `joint1`, `fer_joint1` and `panda_joint1`). Where no name fits, as many
    joints on both sides are taken in order.
    """
    by_name = [_by_key([key(n) for n in log], [key(n) for n in robot]) for key in (str, _plain, _bare)]
    for found in by_name:
        if found and None not in found:
            return _match(found, "name", log)
    prefixed = _without_prefix([_bare(n) for n in log], [_bare(n) for n in robot])
    if len(prefixed) == 1:
        return _match(next(iter(prefixed.values())), "name without prefix", log)
    if prefixed:
        return JointMatch((None,) * len(robot), "", tuple(log), tuple(sorted(prefixed)))
    some = next((found for found in by_name if found and any(i is not None for i in found)), None)
    if len(log) == len(robot) and (some is None or all(i in (None, k) for k, i in enumerate(some))):
        return JointMatch(tuple(range(len(robot))), "order")
    return _match(some, "name", log) if some else JointMatch((None,) * len(robot), "", tuple(log))


def _match(index: Sequence[int | None], how: str, log: Sequence[str]) -> JointMatch:
    return JointMatch(tuple(index), how, tuple(name for k, name in enumerate(log) if k not in index))


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", name.lower())


def _bare(name: str) -> str:
    return _plain(name).removesuffix("joint") or _plain(name)


def _by_key(log: list[str], robot: list[str]) -> list[int | None] | None:
    if len(set(log)) != len(log) or len(set(robot)) != len(robot):
        return None
    return [log.index(name) if name in log else None for name in robot]


def _without_prefix(log: list[str], robot: list[str]) -> dict[str, list[int | None]]:
    """Prefix in the log to the joints found, for each prefix that gives all of the robot's."""
    if len(set(robot)) != len(robot):
        return {}
    found: dict[str, list[int | None]] = {}
    cores = [robot] + [[n[cut:] for n in robot] for cut in range(1, _common(robot) + 1)]
    for core in cores:
        if any(not name for name in core):
            break
        for prefix in {name[: -len(core[0])] for name in log if name.endswith(core[0])}:
            wanted = [prefix + name for name in core]
            if all(log.count(name) == 1 for name in wanted):
                joints: list[int | None] = [log.index(name) for name in wanted]
                if joints not in found.values():
                    found[prefix] = joints
        if found:
            return found
    return found


def _common(names: Sequence[str]) -> int:
    shortest = min(map(len, names), default=0)
    return next((k for k in range(shortest) if len({n[k] for n in names}) > 1), shortest) if len(names) > 1 else 0
