"""The report of a diagnosis on motion: where rollouts of the commands leave the recorded motion, and why."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from lagnet.diagnosis.motion.diagnose import MotionDiagnosis
from lagnet.diagnosis.verdict.report_data import ReportData
from lagnet.reports.contents.findings import Findings
from lagnet.reports.contents.replay_data import ReplayData
from lagnet.reports.page import Section, write_page
from lagnet.reports.sections import (
    abstentions,
    motion_curves,
    motion_errors,
    motion_headline,
    motion_rest,
    parameters,
    where,
    your_simulator,
)
from lagnet.reports.wording import compared

# In order of reading. A new section is one file beside these, with its template, and one line here.
OF_MOTION: tuple[Callable[[Mapping[str, Any], MotionDiagnosis], Section | None], ...] = (
    motion_headline.build,
    motion_errors.build,
    motion_curves.build,
    motion_rest.build,
)
OF_VERDICT = (your_simulator.of_diagnosis, where.build, parameters.build, abstentions.build)


def write_motion_report(diagnosis: MotionDiagnosis, path: str | Path, replay: ReplayData | None = None) -> Path:
    """Write the diagnosis as one self-contained HTML page; replay: of held-out recordings in the user's simulator.

    Returns:
        The file that was written.
    """
    verdict = diagnosis.verdict.to_dict()
    findings = Findings(verdict, ReportData(), replay)
    built = [build(verdict, diagnosis) for build in OF_MOTION] + [build(findings) for build in OF_VERDICT]
    parts = [part for part in built if part is not None]
    return write_page(path, "Commands and motion", f"{compared(verdict)}, on motion", parts)
