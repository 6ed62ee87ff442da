"""What is wrong with the data, and what mends it; left out where nothing was found."""

from __future__ import annotations

from lagnet.reports.contents.findings import Findings
from lagnet.reports.page import Section, section


def build(findings: Findings) -> Section | None:
    """A row a finding, in the order of the checks."""
    rows = [{**row, "time": _time(row["interval_s"])} for row in findings.verdict.get("data_quality", ())]
    return section("data_quality", "What is wrong with the data", rows=rows) if rows else None


def _time(interval: list[float] | None) -> str:
    if interval is None:
        return "throughout"
    first, last = interval
    return f"{first:.4g} s" if first == last else f"{first:.4g} s to {last:.4g} s"
