"""Each joint by itself: its torque before and after, what the model misses at which velocity, and what explains it."""

from __future__ import annotations

from typing import Any

from lagnet.reports.contents.findings import Findings
from lagnet.reports.figures.figure import Figure
from lagnet.reports.figures.joint_figures import residual_by_velocity, torque_over_time
from lagnet.reports.page import Section, section
from lagnet.reports.sections.fit import layers_of


def build(findings: Findings) -> Section:
    """A panel for every joint, one of them shown at a time; all of them on paper."""
    panels = [_panel(findings, index, joint) for index, joint in enumerate(findings.joints)]
    figures = [panel[kind] for panel in panels for kind in ("time", "velocity") if panel[kind] is not None]
    return section(
        "joints",
        "Joint by joint, on held-out recordings",
        figures,
        panels=panels,
        kinds=layers_of(findings.verdict["fit"]),
        first=_most_telling(findings),
        bandwidth=findings.verdict["conditioning"]["bandwidth_hz"],
    )


def _panel(findings: Findings, index: int, joint: str) -> dict[str, Any]:
    evidence, n = findings.evidence_on(joint), len(findings.joints)
    figures: dict[str, Figure | None] = {
        "time": torque_over_time(f"joint-{index}-time", evidence, n),
        "velocity": residual_by_velocity(f"joint-{index}-velocity", evidence, n),
    }
    return {
        "index": index,
        "joint": joint,
        "differs": joint in findings.differing,
        "fit": findings.fit(joint),
        "mismatch": findings.mismatch(joint),
        "unit": evidence.unit,
        "predictable": evidence.predictable_share,
        "effects": findings.effects_on(joint),
        **figures,
    }


def _most_telling(findings: Findings) -> int:
    """The joint whose fit gains most: there the reader sees what the verdict speaks of."""
    gains = [fit.get("nmse_nominal", 0.0) - fit.get("nmse_named", 0.0) for fit in map(findings.fit, findings.joints)]
    return max(range(len(gains)), key=gains.__getitem__, default=0)
