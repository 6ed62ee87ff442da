"""The parameters of one robot over time, with its changes, its sisters and links to every diagnosis."""

from __future__ import annotations

from lagnet.reports.contents.fleet import Fleet
from lagnet.reports.page import Section, section


def build(fleet: Fleet) -> Section:
    """The frame; the script draws the robot that is chosen."""
    return section("fleet_timeline", "One robot over time")
