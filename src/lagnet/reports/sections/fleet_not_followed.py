"""What searches named and the timelines do not hold, with the reason."""

from __future__ import annotations

from lagnet.reports.contents.fleet import Fleet
from lagnet.reports.page import Section, section

MOST = 200  # rows on the page; the table beside it holds all


def build(fleet: Fleet) -> Section | None:
    """One row for each effect, joint and robot, those named most often first; nothing where all are followed."""
    rows = sorted(fleet.not_followed, key=lambda one: -one.named)
    if not rows:
        return None
    return section("fleet_not_followed", "Named and not followed", rows=rows[:MOST], more=max(0, len(rows) - MOST))
