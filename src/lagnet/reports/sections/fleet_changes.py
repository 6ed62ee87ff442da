"""Every change of every robot in one table."""

from __future__ import annotations

from lagnet.reports.contents.fleet import Fleet
from lagnet.reports.page import Section, section


def build(fleet: Fleet) -> Section:
    """The frame of the table; its rows come from the page's data."""
    return section("fleet_changes", "All changes")
