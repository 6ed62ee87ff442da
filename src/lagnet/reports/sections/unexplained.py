"""What is left after the named physics, the signals that predict it, and how it looks against the strongest."""

from __future__ import annotations

from typing import Any

from lagnet.reports.contents.findings import Findings
from lagnet.reports.figures.figure import Figure
from lagnet.reports.figures.remainder_figures import formula_words, remainder_by_signal
from lagnet.reports.page import Section, section

PICTURES = 3  # joints with a picture: those with most left


def build(findings: Findings) -> Section | None:
    """One row a joint; the predictable share tells how much of the remainder anything could predict at all."""
    rows = [_row(findings, entry) for entry in findings.verdict["unexplained"]]
    if not rows or not findings.verdict["mismatch"]["found"]:
        return None
    pictures = _pictures(findings, rows)
    return section(
        "unexplained",
        "What stays unexplained",
        [figure for _, figure in pictures],
        rows=rows,
        pictures=pictures,
        any_left=any(row["above_noise"] for row in rows),
    )


def _row(findings: Findings, entry: dict[str, Any]) -> dict[str, Any]:
    evidence = findings.evidence_on(entry["joint"])
    return {**entry, "predictable": evidence.predictable_share, "words": formula_words(evidence)}


def _pictures(findings: Findings, rows: list[dict[str, Any]]) -> list[tuple[dict[str, Any], Figure]]:
    sliding = frozenset(i for i, j in enumerate(findings.joints) if findings.evidence_on(j).unit == "N")
    ranked = sorted((r for r in rows if r["above_noise"]), key=lambda r: -r["share_of_mismatch"])
    drawn = []
    for row in ranked:
        key = f"left-{findings.joints.index(row['joint'])}" if row["joint"] in findings.joints else "left"
        figure = remainder_by_signal(key, findings.evidence_on(row["joint"]), sliding)
        if figure is not None:
            drawn.append((row, figure))
    return drawn[:PICTURES]
