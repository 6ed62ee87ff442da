"""The report of `lagnet decompose`: where each joint's torque goes, and how well each part agrees with a reference."""

from __future__ import annotations

from pathlib import Path

from lagnet.decomposition.decompose import Decomposition
from lagnet.reports.page import write_page
from lagnet.reports.sections import (
    decomposition_agreement,
    decomposition_energy,
    decomposition_headline,
    decomposition_shares,
    decomposition_terms,
)
from lagnet.reports.wording import counted, file_name


def write_decomposition_report(parts: Decomposition, model: str, reference: str | None, path: str | Path) -> Path:
    """Write the decomposition as one self-contained HTML page.

    Args:
        parts: what `decompose` returns.
        model, reference: names or paths, as the user gave them.
        path: the file to write; replaced in one step.
    """
    sections = [
        decomposition_headline.build(parts),
        decomposition_shares.build(parts),
        decomposition_agreement.build(parts),
        decomposition_terms.build(parts),
        decomposition_energy.build(parts),
    ]
    against = f", beside {file_name(reference)}" if reference else ""
    subtitle = f"{file_name(model)}{against}, along {counted(len(parts.sources), 'recording')}"
    return write_page(path, "Where the torque goes", subtitle, sections)
