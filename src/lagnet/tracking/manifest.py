"""The manifest of a fleet: makes with their nominal models, robots, and recordings with dates.

[[make]]                                  # robots that were built alike share one
name = "planar"
robot = "planar.urdf"                     # nominal model: file, name of example-robot-data, or folder of a diagnosis
calibration = ["calibration/*.parquet"]   # optional: recordings of a healthy robot, for a common calibrated model

[[robot]]
name = "arm_01"
make = "planar"
[[robot.recordings]]
files = "arm_01/*.parquet"
date_in_name = "%Y-%m-%d"                 # or date = 2026-01-31 for a single file

Large fleets state `index = "recordings.csv"` with robot, make, file, date; optionally temperature, gain.
"""

from __future__ import annotations

import errno
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Any

from lagnet.errors import LagnetError, closest
from lagnet.files import read_bounded
from lagnet.tracking.dates import as_date
from lagnet.tracking.files import exists, join, matching
from lagnet.tracking.index import MOST_GAIN, read_index

MAX_BYTES = 64 * 1024**2
TOP = ("make", "robot", "index", "settings")
MAKE = ("name", "robot", "columns", "torque_constant", "hold", "calibration", "actuator")
ROBOT = ("name", "make", "recordings")
SEARCHES = ("every", "unusual")
ENTRY = ("files", "date", "date_in_name", "temperature", "gain")


@dataclass(frozen=True)
class TrackSettings:
    """How the recordings of a fleet are diagnosed.

    Args:
        bandwidth: low-pass on torques [Hz]; None: that of the calibration, the same for all recordings of a make.
        seed: of everything random.
        reports: whether every diagnosis gets its own page, of about 5 MB each.
        search: "every" recording is searched for physics beyond the set, or only "unusual" ones, which the fitted set
            explains clearly worse than it did those of the calibration: several times quicker.
        false_discovery_rate: expected share of wrong ones among the changes that are told.
        temperature_sigma: standard deviation between the temperature told and that of a joint's friction [K].
    """

    bandwidth: float | None = None
    seed: int = 0
    reports: bool = True
    search: str = "every"
    false_discovery_rate: float = 0.01
    temperature_sigma: float = 0.5


@dataclass(frozen=True)
class Make:
    """Robots that were built alike.

    Args:
        name: of the make.
        robot: the nominal model, as `lagnet.load_robot` takes it.
        columns: mapping file of foreign columns, or None.
        torque_constant: one a joint [N m/A] or [N/A], or None.
        hold: joints that no recording tells of, and where they are held [rad or m].
        calibration: recordings of a healthy robot of this make.
        actuator: file of the nominal servos, where recordings hold commands and no torque; None: those of the robot.
    """

    name: str
    robot: str
    columns: str | None = None
    torque_constant: tuple[float, ...] | None = None
    hold: Mapping[str, float] = field(default_factory=dict)
    calibration: tuple[str, ...] = ()
    actuator: str | None = None


@dataclass(frozen=True)
class TrackedRecording:
    """One recording of a robot.

    Args:
        robot: name of the robot.
        make: name of its make.
        file: path or address.
        date: when it was recorded.
        temperature: of the joints where it is known from elsewhere [°C]; None: that of the file, if it holds any.
        gain: of the controller over the nominal servo's, where commands were recorded and no torque.
    """

    robot: str
    make: str
    file: str
    date: datetime
    temperature: float | None = None
    gain: float = 1.0


@dataclass(frozen=True)
class Manifest:
    """What is to be tracked: makes by name, recordings sorted by robot and date."""

    makes: Mapping[str, Make]
    recordings: tuple[TrackedRecording, ...]
    settings: TrackSettings = field(default_factory=TrackSettings)

    @property
    def robots(self) -> tuple[str, ...]:
        """Names of the robots, sorted."""
        return tuple(sorted({r.robot for r in self.recordings}))


def read_manifest(path: str | Path) -> Manifest:
    """The fleet that a TOML file states.

    Raises:
        LagnetError: not readable, keys that mean nothing, names that are not declared, globs that match no file,
            recordings without a date, or one recording twice.
    """
    path = Path(path).resolve()
    where, data = str(path), _parse(path)
    _known(data, TOP, where)
    makes = {m.name: m for m in (_make(entry, path.parent, where) for entry in _tables(data, "make", where))}
    if not makes:
        raise LagnetError("states no make", where=where, next_step="add [[make]] with name and robot")
    found = [r for entry in _tables(data, "robot", where) for r in _robot(entry, makes, path.parent, where)]
    if "index" in data:
        rows = read_index(path.parent / str(data["index"]))
        found += [
            TrackedRecording(
                r.robot, _declared(r.make, makes, where), join(path.parent, r.file), r.date, r.temperature, r.gain
            )
            for r in rows
        ]
    if not found:
        raise LagnetError("states no recording", where=where, next_step="add [[robot]] with recordings, or an index")
    return Manifest(makes, _ordered(found, where), _settings(data.get("settings", {}), where))


def _ordered(found: list[TrackedRecording], where: str) -> tuple[TrackedRecording, ...]:
    seen: dict[str, TrackedRecording] = {}
    for one in found:
        if one.file in seen:
            raise LagnetError(
                f"the recording {one.file} is stated twice, for {seen[one.file].robot} and {one.robot}", where=where
            )
        seen[one.file] = one
    make_of: dict[str, str] = {}
    for one in found:
        if make_of.setdefault(one.robot, one.make) != one.make:
            raise LagnetError(f"{one.robot} is stated with two makes, {make_of[one.robot]} and {one.make}", where=where)
    return tuple(sorted(found, key=lambda r: (r.robot, r.date, r.file)))


def _parse(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(read_bounded(path, MAX_BYTES).decode("utf-8-sig"))
    except OSError as error:
        step = "use an index file" if error.errno == errno.EFBIG else None
        raise LagnetError(f"cannot be read ({error.strerror})", where=str(path), next_step=step) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise LagnetError(f"is not valid TOML ({error})", where=str(path)) from None


def _tables(data: Mapping[str, Any], key: str, where: str) -> list[dict[str, Any]]:
    tables = data.get(key, [])
    if not isinstance(tables, list) or not all(isinstance(t, dict) for t in tables):
        raise LagnetError(f"{key} must be tables", where=where, next_step=f"write [[{key}]] above each of them")
    return tables


def _known(table: Mapping[str, Any], valid: tuple[str, ...], where: str) -> None:
    for key in table:
        if key not in valid:
            near = closest(key, valid)
            hint = f"did you mean {near}?" if near else None
            raise LagnetError(f"{key!r} means nothing here", where=where, choices=valid, next_step=hint)


def _text(table: Mapping[str, Any], key: str, where: str) -> str:
    value = table.get(key)
    if not isinstance(value, str) or not value:
        raise LagnetError(f"{key} is missing or is not text", where=where, next_step=f'write {key} = "…"')
    return value


def _name(table: Mapping[str, Any], where: str) -> str:
    name = _text(table, "name", where)
    if not name.strip(".") or any(c in name for c in '/\\:*?"<>|') or not name.isprintable():
        raise LagnetError(f"the name {name!r} cannot be the name of a folder", where=where, next_step="rename it")
    return name


def _make(table: dict[str, Any], base: Path, where: str) -> Make:
    name = _name(table, f"{where}, [[make]]")
    place = f"{where}, make {name}"
    _known(table, MAKE, place)
    robot = _text(table, "robot", place)
    constants, hold = table.get("torque_constant"), table.get("hold", {})
    numbers = [*(constants or []), *(hold.values() if isinstance(hold, dict) else ["no table"])]
    if not all(isinstance(x, int | float) for x in numbers):
        raise LagnetError("torque_constant must be a list and hold a table of numbers", where=place)
    globs = table.get("calibration", [])
    patterns = [globs] if isinstance(globs, str) else globs
    calibration = tuple(file for pattern in patterns for file in matching(base, str(pattern), place))
    local = str(base / robot) if exists(join(base, robot)) else robot
    columns = None if "columns" not in table else str(base / _text(table, "columns", place))
    actuator = None if "actuator" not in table else str(base / _text(table, "actuator", place))
    torque_constant = None if constants is None else tuple(map(float, constants))
    return Make(name, local, columns, torque_constant, hold, calibration, actuator)


def _declared(make: str, makes: Mapping[str, Make], where: str) -> str:
    if make not in makes:
        raise LagnetError(f"the make {make!r} is not declared", where=where, choices=makes)
    return make


def _robot(table: dict[str, Any], makes: Mapping[str, Make], base: Path, where: str) -> list[TrackedRecording]:
    name = _name(table, f"{where}, [[robot]]")
    place = f"{where}, robot {name}"
    _known(table, ROBOT, place)
    stated = _text(table, "make", place) if "make" in table or len(makes) > 1 else next(iter(makes))
    make = _declared(stated, makes, place)
    out = []
    for entry in _tables(table, "recordings", place):
        _known(entry, ENTRY, place)
        temperature = entry.get("temperature")
        if not (temperature is None or isinstance(temperature, int | float)):
            raise LagnetError("temperature must be a number [°C]", where=place)
        gain = entry.get("gain", 1.0)
        if isinstance(gain, bool) or not isinstance(gain, int | float) or not 0.0 < gain < MOST_GAIN:
            raise LagnetError("gain must be a positive number", where=place, next_step="state it over the nominal gain")
        files = matching(base, _text(entry, "files", place), place)
        if "date" in entry and len(files) > 1:
            raise LagnetError(f"one date for {len(files)} files", where=place, next_step="use date_in_name or an index")
        out += [TrackedRecording(name, make, f, as_date(entry, f, place), temperature, float(gain)) for f in files]
    return out


def _settings(table: dict[str, Any], where: str) -> TrackSettings:
    place = f"{where}, [settings]"
    _known(table, tuple(TrackSettings.__dataclass_fields__), place)
    for key, value in table.items():
        kind = {"seed": int, "reports": bool, "search": str}.get(key, (int, float))
        if not isinstance(value, kind) or (isinstance(value, bool) and key != "reports"):
            raise LagnetError(f"{key} = {value!r} is not a valid value", where=place)
    settings = TrackSettings(**table)
    if not (settings.bandwidth is None or settings.bandwidth > 0) or not 0 < settings.false_discovery_rate < 1:
        raise LagnetError("bandwidth must be positive and false_discovery_rate between 0 and 1", where=place)
    if settings.search not in SEARCHES:
        raise LagnetError(f"search = {settings.search!r} is not known", where=place, choices=SEARCHES)
    if not 0.0 <= settings.temperature_sigma < 100.0:
        raise LagnetError("temperature_sigma must be a number of kelvins from 0 on", where=place)
    return settings
