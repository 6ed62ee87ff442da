"""A fleet in some sentences: how many robots changed, what changed this week, who stands apart."""

from __future__ import annotations

from datetime import datetime

from lagnet.reports.contents.fleet import Fleet, FleetEvent
from lagnet.reports.page import Section, section
from lagnet.reports.wording import counted, effect_words, number

MOST = 12  # changes of the week that are told in words; the table holds all


def build(fleet: Fleet) -> Section:
    """Figures to remember, and the changes of the newest week."""
    changed = {e.robot for e in fleet.events}
    odd = {r.name for r in fleet.robots if any(s.out_of_family for s in r.series)}
    failed = sum(e is not None for r in fleet.robots for e in r.errors)
    recent = fleet.recent()
    tiles = [
        (f"{len(changed)} of {len(fleet.robots)}", "robots changed by more than temperature and load explain"),
        (str(len({e.robot for e in recent})), "robots changed in the newest week"),
        (str(len(odd)), "robots stand apart from their sisters"),
        (str(failed), f"{'recording' if failed == 1 else 'recordings'} could not be diagnosed"),
    ]
    lead = (
        f"{counted(len(changed), 'robot')} of {len(fleet.robots)} changed."
        if changed
        else "No robot changed by more than noise, temperature and load explain."
    )
    return section(
        "fleet_headline",
        "",
        lead=lead,
        calm=not changed and not failed,
        tiles=tiles,
        recent=[(e.robot, words_of(e)) for e in recent[:MOST]],
        more=max(0, len(recent) - MOST),
    )


def words_of(event: FleetEvent) -> str:
    """A change in one line: what, where, how much, since when."""
    where = event.joint or "the whole arm"
    if event.relative:
        size = f"{_sign(100 * event.change)} % ({_sign(100 * event.lower)} to {_sign(100 * event.upper)} %)"
    else:
        size = f"{_sign(event.change)} {event.unit}".rstrip(" –")
    since = "at once on" if event.kind == "step" else "gradually since"
    return f"{effect_words(event.effect)} ({event.parameter}) at {where}: {size}, {since} {_day(event.date)}"


def _day(date: datetime) -> str:
    """The date, with the time of day but at midnight, which dates without a time have."""
    return f"{date:%Y-%m-%d}" if (date.hour, date.minute) == (0, 0) else f"{date:%Y-%m-%d %H:%M}"


def _sign(value: float) -> str:
    return ("+" if value > 0 else "") + number(value, 2)
