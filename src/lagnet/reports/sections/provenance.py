"""What it would take to do it again: the path of the search, settings, versions, checksums."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from lagnet.reports.contents.findings import Findings, place
from lagnet.reports.page import Section, section


def build(findings: Findings) -> Section:
    """A folded block; an engineer opens it to repeat or to doubt."""
    verdict, evidence = findings.verdict, findings.evidence
    path = [{"effect": s.effect, "place": place(s.joint), "nmse": s.holdout_nmse} for s in evidence.selection]
    return section(
        "provenance",
        "How it was found",
        path=path,
        recordings=verdict["recordings"],
        nominal=verdict["nominal"],
        conditioning=verdict["conditioning"],
        seed=verdict["seed"],
        version=verdict["lagnet_version"],
        settings=list(_flat(evidence.settings)),
        versions=sorted(evidence.versions.items()),
        checksums=sorted(evidence.checksums.items()),
    )


def _flat(settings: Mapping[str, Any], prefix: str = "") -> list[tuple[str, str]]:
    """Nested settings as dotted names and printed values."""
    rows: list[tuple[str, str]] = []
    for name, value in settings.items():
        if isinstance(value, Mapping):
            rows += _flat(value, f"{prefix}{name}.")
        else:
            rows.append((f"{prefix}{name}", str(value)))
    return rows
