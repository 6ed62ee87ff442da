"""Foreign column names, units and torque constants, stated in a TOML file (`--columns map.toml`).

[columns]                       # our name = the file's name
time = "timestamp"
"q_0" = "actual_q_0"            # one column
v = "actual_qd_{i}"             # every joint: {i} counts from 0, {i1} from 1, {joint} is the joint's name
[scale]                         # what the file's numbers are multiplied by to become SI
time = 1e-3
q = 0.0174532925                # every joint ...
"q_6" = 0.001                   # ... unless the column has its own
[offset]                        # what is then added, in SI units: a zero that lies elsewhere
"q_1" = -1.5707963268
[torque_constant]               # N m (or N) per ampere at the joint, one a joint
values = [14.87, 13.26, 11.13, 10.62, 11.03, 11.47]
"""

from __future__ import annotations

import errno
import math
import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lagnet.errors import RecordingError, closest
from lagnet.files import read_bounded
from lagnet.recordings.signals import JOINT_SIGNALS, kind_of

KINDS = ("time", "trajectory", *JOINT_SIGNALS)
SECTIONS = ("columns", "scale", "offset", "torque_constant")
MAX_BYTES = 1024**2


@dataclass(frozen=True)
class ColumnMap:
    """How a file's own columns become ours.

    Args:
        columns: our name (q_0, q_elbow, time; or a kind alone: q) to the file's name or pattern.
        scale: our name or kind to the factor that makes SI units.
        torque_constant: [N m/A] or [N/A], one a joint, or None.
        path: where it was read from.
        offset: our name or kind to what is added after scaling, in SI units.
    """

    columns: dict[str, str] = field(default_factory=dict)
    scale: dict[str, float] = field(default_factory=dict)
    torque_constant: tuple[float, ...] | None = None
    path: str = "mapping"
    offset: dict[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for section in ("columns", "scale", "offset"):
            for name in getattr(self, section):
                self._check_name(section, name)
        for name, file_name in self.columns.items():
            if not isinstance(file_name, str) or (not file_name and kind_of(name) is None):
                raise self._error(f"[columns] {name} must be the file's column name, in quotes")
        for name, factor in self.scale.items():
            if not _is_number(factor) or factor == 0:
                raise self._error(f"[scale] {name} must be a number other than zero, not {factor!r}")
        for name, added in self.offset.items():
            if not _is_number(added):
                raise self._error(f"[offset] {name} must be a number, not {added!r}")
        for section in ("scale", "offset"):
            if "trajectory" in getattr(self, section):
                raise self._error(f"[{section}] trajectory has no unit")
        for value in self.torque_constant or ():
            if not _is_number(value) or value == 0:
                raise self._error(f"[torque_constant] values must be numbers other than zero, not {value!r}")

    def file_name(self, kind: str, index: int, joint: str) -> str | None:
        """The file's name of a joint's column, or None where the map says nothing of it."""
        for ours in (f"{kind}_{index}", f"{kind}_{joint}"):
            if ours in self.columns:
                return self.columns[ours]
        pattern = self.columns.get(kind)
        if pattern is None:
            return None
        if not pattern:
            return ""
        if "{" not in pattern:
            return f"{pattern}_{index}"
        return pattern.replace("{i}", str(index)).replace("{i1}", str(index + 1)).replace("{joint}", joint)

    def factor(self, kind: str, index: int = 0, joint: str = "") -> float:
        """What the file's numbers are multiplied by."""
        return self._stated(self.scale, kind, index, joint, 1.0)

    def added(self, kind: str, index: int = 0, joint: str = "") -> float:
        """What is added to the file's numbers after that."""
        return self._stated(self.offset, kind, index, joint, 0.0)

    def states_unit(self, kind: str, index: int, joint: str) -> bool:
        """Whether the user stated a factor for this column, so that its unit is not to be guessed."""
        return any(ours in self.scale for ours in (f"{kind}_{index}", f"{kind}_{joint}", kind))

    @staticmethod
    def _stated(values: dict[str, float], kind: str, index: int, joint: str, default: float) -> float:
        for ours in (f"{kind}_{index}", f"{kind}_{joint}", kind):
            if ours in values:
                return float(values[ours])
        return default

    def _check_name(self, section: str, name: str) -> None:
        if name not in KINDS and kind_of(name) is None:
            near = closest(name, KINDS)
            raise self._error(
                f"[{section}] {name} is no column of ours" + (f", did you mean {near}?" if near else ""),
                "use time, trajectory, q_0, v_0, a_0, tau_0, current_0 … or a kind alone, e.g. q",
            )

    def _error(self, what: str, next_step: str | None = None) -> RecordingError:
        return RecordingError(what, where=self.path, next_step=next_step)


def read_column_map(path: str | Path) -> ColumnMap:
    """The mapping that a TOML file states.

    Raises:
        RecordingError: not readable, not TOML, or sections and keys that mean nothing.
    """
    where = str(path)
    data = _parse(Path(path), where)
    for section, content in data.items():
        if section not in SECTIONS or not isinstance(content, dict):
            raise RecordingError(f"[{section}] is no section of a mapping", where=where, choices=SECTIONS)
    constants = data.get("torque_constant", {})
    values = constants.get("values")
    if set(constants) - {"values"} or not (values is None or isinstance(values, list)):
        raise RecordingError(
            "[torque_constant] must hold one list", where=where, next_step="write values = [...], one number a joint"
        )
    return ColumnMap(
        data.get("columns", {}),
        data.get("scale", {}),
        None if values is None else tuple(values),
        where,
        data.get("offset", {}),
    )


def _parse(path: Path, where: str) -> dict[str, Any]:
    try:
        text = read_bounded(path, MAX_BYTES)
    except OSError as error:
        if error.errno == errno.EFBIG:
            raise RecordingError(f"{error.strerror}, too long for a mapping", where=where) from None
        raise RecordingError(f"cannot be read ({error.strerror})", where=where) from None
    try:
        return tomllib.loads(text.decode("utf-8-sig"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise RecordingError(
            f"is not valid TOML ({error})", where=where, next_step='write lines such as "q_0" = "actual_q_0"'
        ) from None


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
