"""What the page of a fleet is made from: robots, their parameters over time, and what changed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

import numpy as np

WEEK = timedelta(days=7)


@dataclass(frozen=True)
class FleetEvent:
    """A change; see `lagnet.tracking.statistics.analyse.Event`."""

    robot: str
    joint: str | None
    effect: str
    parameter: str
    unit: str
    kind: str
    date: datetime
    earliest: datetime
    latest: datetime
    change: float
    lower: float
    upper: float
    relative: bool
    temperature_known: bool


@dataclass(frozen=True, eq=False)
class FleetSeries:
    """A parameter of one robot over its recordings.

    Args:
        joint, effect, parameter, unit: what it is; joint None for the whole arm.
        at: shape (n,), indices of the robot's recordings.
        value, lower, upper: shape (n,), with the 95 % interval.
        adjusted: shape (n,), at usual temperature and load.
        family: where 95 % of the sisters lie, None where there are too few.
        out_of_family: whether the robot stands apart.
        by_temperature: relative range of what temperature explains, None where it is not known.
    """

    joint: str | None
    effect: str
    parameter: str
    unit: str
    at: np.ndarray
    value: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    adjusted: np.ndarray
    family: tuple[float, float] | None
    out_of_family: bool
    by_temperature: float | None


@dataclass(frozen=True, eq=False)
class FleetRobot:
    """One robot.

    Args:
        name, make: of the robot.
        joints: in model order.
        dates: of its recordings, in order.
        recordings: their paths.
        pages: page of each diagnosis, seen from the report; None where there is none.
        errors: why there is none.
        temperature: shape (n_recordings,), mean over the joints, NaN where not known [°C].
        series: its parameters.
    """

    name: str
    make: str
    joints: tuple[str, ...]
    dates: tuple[datetime, ...]
    recordings: tuple[str, ...]
    pages: tuple[str | None, ...]
    errors: tuple[str | None, ...]
    temperature: np.ndarray
    series: tuple[FleetSeries, ...]


@dataclass(frozen=True)
class FleetNotFollowed:
    """An effect that searches named and that is not followed; see `lagnet.tracking.growth.NotFollowed`."""

    robot: str
    joint: str
    effect: str
    named: int
    recordings: int
    reason: str


@dataclass(frozen=True, eq=False)
class Fleet:
    """All robots, what changed, oldest first, and what was named and is not followed."""

    robots: Sequence[FleetRobot]
    events: Sequence[FleetEvent]
    not_followed: Sequence[FleetNotFollowed] = ()

    @property
    def newest(self) -> datetime | None:
        """Date of the newest recording."""
        return max((r.dates[-1] for r in self.robots if r.dates), default=None)

    def recent(self) -> list[FleetEvent]:
        """Changes whose date may lie in the week before the newest recording."""
        newest = self.newest
        return [] if newest is None else [e for e in self.events if e.kind == "step" and e.latest > newest - WEEK]
