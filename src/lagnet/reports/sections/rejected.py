"""What was considered and not named, with the rule and the figure that decided."""

from __future__ import annotations

from lagnet.diagnosis.rules.catalogue import RULES
from lagnet.reports.contents.findings import Findings, place
from lagnet.reports.page import Section, section


def build(findings: Findings) -> Section | None:
    """One row for each effect and joint; nothing where no effect was rejected."""
    statements = {rule.name: rule.statement for rule in RULES}
    rows = [
        {**row, "place": place(row["joint"]), "statement": statements.get(row["rule"], row["rule"])}
        for row in findings.verdict.get("rejected", ())
    ]
    return section("rejected", "Considered and rejected", rows=rows) if rows else None
