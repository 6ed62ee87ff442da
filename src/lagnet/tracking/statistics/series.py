"""One parameter of one robot over time, on the scale on which changes are compared."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from datetime import datetime

import numpy as np

from lagnet.tracking.statistics.followed_law import lower_bound

NORMAL = 1.959964  # half a 95 % interval in standard deviations
LOG_SHARE = 0.9  # of the values of a group that must be clearly positive for a logarithmic scale
CLEARLY = 0.3  # standard deviation over value below which a value is clearly positive
ROUNDING = 1e-9  # of a value: an interval no wider than this is none
LEAST = 3  # recordings of a series below which nothing is said about it
DAY = 86400.0

Group = tuple[str, str | None, str, str]


@dataclass(frozen=True)
class Observation:
    """A followed parameter in one recording of one robot.

    Args:
        robot, make, joint, effect, parameter, unit: what it is; joint None for the whole arm.
        value, lower, upper: with the 95 % interval.
        date: of the recording.
        temperature: of the joint [°C], None where not known.
        load: mean torque of the bodies at the joint [N m], None for the whole arm.
        recording: path of the file.
    """

    robot: str
    make: str
    joint: str | None
    effect: str
    parameter: str
    unit: str
    value: float
    lower: float
    upper: float
    date: datetime
    temperature: float | None
    load: float | None
    recording: str

    @property
    def group(self) -> Group:
        """What it may be pooled with over robots."""
        return self.make, self.joint, self.effect, self.parameter


@dataclass(frozen=True, eq=False)
class Series:
    """A parameter of a robot, in order of time.

    Args:
        observations: what it was made from.
        days: shape (n,), since the first of them.
        value, sigma: shape (n,), on the logarithmic scale where `logarithmic`.
        temperature, load: shape (n,), NaN where not known.
        logarithmic: whether changes are relative.
    """

    observations: tuple[Observation, ...]
    days: np.ndarray
    value: np.ndarray
    sigma: np.ndarray
    temperature: np.ndarray
    load: np.ndarray
    logarithmic: bool

    @property
    def robot(self) -> str:
        """Name of the robot."""
        return self.observations[0].robot

    @property
    def group(self) -> Group:
        """Make, joint, effect and parameter."""
        return self.observations[0].group

    def without(self, rows: Iterable[int]) -> Series:
        """The series less some observations, whose days stay as they were."""
        keep = np.setdiff1d(np.arange(self.days.size), list(rows))
        arrays = {n: getattr(self, n)[keep] for n in ("days", "value", "sigma", "temperature", "load")}
        return replace(self, observations=tuple(self.observations[i] for i in keep), **arrays)


def series_of(observations: Sequence[Observation]) -> dict[Group, list[Series]]:
    """Every parameter over time, grouped by what may be pooled; each group on one scale."""
    groups: dict[Group, dict[str, list[Observation]]] = defaultdict(lambda: defaultdict(list))
    for one in observations:
        if np.isfinite([one.value, one.lower, one.upper]).all() and _has_width(one):
            groups[one.group][one.robot].append(one)
    out = {}
    for group in sorted(groups, key=lambda g: tuple(map(str, g))):
        robots = groups[group]
        logarithmic = _is_positive(group, [o for rows in robots.values() for o in rows])
        made = [_series(sorted(robots[r], key=lambda o: (o.date, o.recording)), logarithmic) for r in sorted(robots)]
        out[group] = [s for s in made if s.days.size >= LEAST]
    return {group: series for group, series in out.items() if series}


def _has_width(one: Observation) -> bool:
    """Whether an interval is more than rounding: a direction that no motion shows leaves a width of about 1e-17."""
    return one.upper - one.lower > ROUNDING * max(abs(one.value), abs(one.lower), abs(one.upper))


def _is_positive(group: Group, rows: Sequence[Observation]) -> bool:
    """Whether a parameter that physics keeps positive is clearly above zero nearly everywhere."""
    return lower_bound(group[2], group[3]) >= 0.0 and float(np.mean([_clear(o) for o in rows])) >= LOG_SHARE


def _clear(one: Observation) -> bool:
    return one.value > 0.0 and (one.upper - one.lower) / (2.0 * NORMAL) < CLEARLY * one.value


def _series(rows: Sequence[Observation], logarithmic: bool) -> Series:
    rows = [o for o in rows if not logarithmic or _clear(o)]
    first = rows[0].date if rows else datetime(1970, 1, 1)
    value = np.array([o.value for o in rows])
    sigma = np.array([(o.upper - o.lower) / (2.0 * NORMAL) for o in rows])
    if logarithmic:
        value, sigma = np.log(value), sigma / value
    days = np.array([(o.date - first).total_seconds() / DAY for o in rows])
    temperature, load = (
        np.array([np.nan if getattr(o, n) is None else getattr(o, n) for o in rows], dtype=float)
        for n in ("temperature", "load")
    )
    return Series(tuple(rows), days, value, sigma, temperature, load, logarithmic)
