"""In which regimes the residual sits: at reversals, high speed, under load, for a while."""

from __future__ import annotations

from lagnet.reports.contents.findings import Findings
from lagnet.reports.page import Section, section


def build(findings: Findings) -> Section | None:
    """One row for each regime of each joint that differs."""
    joints = [entry for entry in findings.verdict["mismatch"]["joints"] if entry["significant"] and entry["where"]]
    return section("where", "When it differs", joints=joints) if joints else None
