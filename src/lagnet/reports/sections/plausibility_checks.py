"""All checks with value, limit and the reason for the limit."""

from __future__ import annotations

from lagnet.plausibility.check import place
from lagnet.plausibility.report import PlausibilityReport
from lagnet.reports.page import Section, section

KINDS = {"pass": ("holds", "good"), "fail": ("fails", "bad"), "not_applicable": ("not applicable", "quiet")}


def build(report: PlausibilityReport) -> Section:
    """One row a check, in the order in which they were made."""
    rows = [{"check": c, "badge": KINDS[c.status], "place": place(c.where).removeprefix(" at ")} for c in report.checks]
    return section("plausibility_checks", "All checks", rows=rows)
