"""A fleet as plain data for the page's script: numbers packed, texts once."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from lagnet.reports.contents.fleet import Fleet, FleetEvent, FleetRobot, FleetSeries
from lagnet.reports.figures.figure import packed
from lagnet.reports.wording import effect_words

EPOCH = datetime(1970, 1, 1)
DAY = 86400.0


def page_data(fleet: Fleet) -> dict[str, Any]:
    """What `fleet.js` draws from."""
    index_of = {r.name: i for i, r in enumerate(fleet.robots)}
    recent = {id(e) for e in fleet.recent()}
    return {
        "robots": [_robot(r) for r in fleet.robots],
        "events": [_event(e, index_of[e.robot], id(e) in recent) for e in fleet.events],
    }


def days_of(date: datetime) -> float:
    """Days since 1970."""
    return (date - EPOCH).total_seconds() / DAY


def _robot(robot: FleetRobot) -> dict[str, Any]:
    start = min(map(days_of, robot.dates), default=0.0)
    return {
        "name": robot.name,
        "make": robot.make,
        "joints": list(robot.joints),
        "start": start,
        "days": packed([days_of(d) - start for d in robot.dates])["bdata"],
        "recordings": list(robot.recordings),
        "pages": list(robot.pages),
        "errors": {str(i): e for i, e in enumerate(robot.errors) if e is not None},
        "temperature": packed(robot.temperature)["bdata"],
        "series": [_series(s) for s in robot.series],
    }


def _series(one: FleetSeries) -> dict[str, Any]:
    return {
        "joint": one.joint,
        "effect": effect_words(one.effect),
        "parameter": one.parameter,
        "unit": one.unit,
        "at": packed(one.at)["bdata"],
        **{n: packed(getattr(one, n))["bdata"] for n in ("value", "lower", "upper", "adjusted")},
        "family": one.family,
        "odd": one.out_of_family,
        "warmth": one.by_temperature,
    }


def _event(event: FleetEvent, robot: int, recent: bool) -> dict[str, Any]:
    plain = {
        n: getattr(event, n) for n in ("joint", "parameter", "unit", "kind", "change", "lower", "upper", "relative")
    }
    dates = {n: days_of(getattr(event, n)) for n in ("date", "earliest", "latest")}
    known = event.temperature_known
    return plain | dates | {"robot": robot, "effect": effect_words(event.effect), "recent": recent, "warm": known}
