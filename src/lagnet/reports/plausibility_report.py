"""The report of `lagnet check`: which statements of physics hold, which do not, and where."""

from __future__ import annotations

from pathlib import Path

from lagnet.plausibility.report import PlausibilityReport
from lagnet.reports.page import write_page
from lagnet.reports.sections import plausibility_checks, plausibility_headline
from lagnet.reports.wording import counted, file_name


def write_plausibility_report(report: PlausibilityReport, model: str, path: str | Path) -> Path:
    """Write the findings as one self-contained HTML page.

    Args:
        report: what the suite found.
        model: name or path of the model, as the user gave it.
        path: the file to write; replaced in one step.
    """
    parts = [plausibility_headline.build(report), plausibility_checks.build(report)]
    subtitle = f"{file_name(model)}, {counted(len(report.joints), 'joint')}"
    return write_page(path, "Can this be a real arm?", subtitle, parts)
