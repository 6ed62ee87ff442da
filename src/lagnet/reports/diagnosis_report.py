"""The report of a diagnosis: one page that says in a minute where the arm differs from its model, and why."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from lagnet.diagnosis.verdict.report_data import ReportData
from lagnet.reports.contents.findings import Findings
from lagnet.reports.contents.replay_data import ReplayData
from lagnet.reports.page import Section, write_page
from lagnet.reports.sections import (
    abstentions,
    arm,
    arm_view,
    data_quality,
    fit,
    headline,
    identified,
    joints,
    overlay,
    parameters,
    provenance,
    rejected,
    rivals,
    unexplained,
    where,
    your_simulator,
)
from lagnet.reports.wording import compared

# In order of reading. A new section is one file beside these, with its template, and one line here.
SECTIONS: tuple[Callable[[Findings], Section | None], ...] = (
    headline.build,
    data_quality.build,
    arm.build,
    fit.build,
    arm_view.build,
    joints.build,
    your_simulator.of_diagnosis,
    overlay.build,
    where.build,
    rivals.build,
    rejected.build,
    identified.build,
    unexplained.build,
    abstentions.build,
    parameters.build,
    provenance.build,
)


def write_report(
    verdict: Mapping[str, Any], evidence: ReportData, path: str | Path, replay: ReplayData | None = None
) -> Path:
    """Write the diagnosis as one self-contained HTML page.

    Args:
        verdict: valid under verdict.schema.json.
        evidence: the arrays behind it; what is absent is left out.
        path: the file to write; replaced in one step.
        replay: held-out recordings through the user's simulator, before and after; None: they were not replayed.

    Returns:
        The file that was written.
    """
    findings = Findings(verdict, evidence, replay)
    parts = [part for part in (build(findings) for build in SECTIONS) if part is not None]
    return write_page(path, "Simulation against recordings", compared(verdict), parts)
