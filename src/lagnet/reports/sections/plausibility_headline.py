"""The verdict on a model in one sentence, and its failures with what they mean."""

from __future__ import annotations

from lagnet.plausibility.check import NOT_APPLICABLE, PASS, place
from lagnet.plausibility.report import PlausibilityReport
from lagnet.reports.page import Section, section


def build(report: PlausibilityReport) -> Section:
    """What is wrong, the most basic first."""
    count = {status: sum(c.status == status for c in report.checks) for status in (PASS, NOT_APPLICABLE)}
    failures = [{"check": c, "place": place(c.where).removeprefix(" at ")} for c in report.failures]
    return section(
        "plausibility_headline", "", failures=failures, held=count[PASS], beside_the_point=count[NOT_APPLICABLE]
    )
