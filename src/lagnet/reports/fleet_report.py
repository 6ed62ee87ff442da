"""The report of `lagnet track`: a fleet on one page, and a timeline of each robot with links to its diagnoses."""

from __future__ import annotations

from pathlib import Path

from lagnet.reports.contents.fleet import Fleet
from lagnet.reports.page import write_page
from lagnet.reports.sections import fleet_changes, fleet_headline, fleet_not_followed, fleet_robots, fleet_timeline
from lagnet.reports.sections.fleet_data import page_data
from lagnet.reports.wording import counted


def write_fleet_report(fleet: Fleet, path: str | Path) -> Path:
    """Write the fleet as one self-contained HTML page; tables and timelines are drawn by its script when looked at.

    Args:
        fleet: robots and changes.
        path: the file to write; replaced in one step.
    """
    sections = (fleet_headline, fleet_robots, fleet_timeline, fleet_changes, fleet_not_followed)
    parts = [part for section in sections if (part := section.build(fleet)) is not None]
    n_recordings = sum(len(r.dates) for r in fleet.robots)
    subtitle = f"{counted(len(fleet.robots), 'robot')}, {counted(n_recordings, 'recording')}"
    if fleet.newest is not None:
        subtitle += f", the newest of {fleet.newest:%Y-%m-%d}"
    return write_page(path, "A fleet over time", subtitle, parts, data={"fleet": page_data(fleet)}, script="fleet.js")
