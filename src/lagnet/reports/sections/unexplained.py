"""What is left after the named physics, and the signals that predict it."""

from __future__ import annotations

from lagnet.reports.findings import Findings
from lagnet.reports.page import Section, section


def build(findings: Findings) -> Section | None:
    """One row a joint; the ceiling tells how much of the residual anything could predict at all."""
    rows = [
        {**entry, "ceiling": findings.evidence_on(entry["joint"]).ceiling_share}
        for entry in findings.verdict["unexplained"]
    ]
    if not rows or not findings.verdict["mismatch"]["found"]:
        return None
    return section("unexplained", "What stays unexplained", rows=rows, any_left=any(row["above_noise"] for row in rows))
