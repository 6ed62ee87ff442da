"""Every parameter of every effect, with its unit and 95 % interval."""

from __future__ import annotations

from lagnet.reports.contents.findings import Findings, place
from lagnet.reports.page import Section, section


def build(findings: Findings) -> Section | None:
    """One row a parameter."""
    if not findings.effects:
        return None
    effects = [{**effect, "place": place(effect["joint"])} for effect in findings.effects]
    return section("parameters", "Parameters", effects=effects)
