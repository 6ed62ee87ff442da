"""What these recordings cannot show, and what to record so that the next ones can."""

from __future__ import annotations

from typing import Any

from lagnet.reports.contents.findings import Findings, place
from lagnet.reports.page import Section, section


def build(findings: Findings) -> Section:
    """Hypotheses left unjudged; joints with the same reason and the same advice share a row."""
    rows: dict[tuple[str, str, str], dict[str, Any]] = {}
    for entry in findings.verdict["abstentions"]:
        key = (entry["effect"], entry["reason"], entry["record_next"])
        rows.setdefault(key, {**entry, "places": []})["places"].append(place(entry["joint"]))
    return section("abstentions", "Not judged, and what to record next", rows=list(rows.values()))
