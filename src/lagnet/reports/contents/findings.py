"""A verdict and its evidence, asked the questions that the sections of the report ask."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from lagnet.diagnosis.verdict.report_data import JointEvidence, ReportData
from lagnet.reports.contents.replay_data import ReplayData

WHOLE_ARM = "the whole arm"


@dataclass(frozen=True)
class Findings:
    """What a section is built from.

    Args:
        verdict: valid under verdict.schema.json.
        evidence: the arrays behind it; whatever is absent is left out of the page.
        replay: the held-out recordings through the user's simulator, where they were replayed.
    """

    verdict: Mapping[str, Any]
    evidence: ReportData
    replay: ReplayData | None = None

    @property
    def joints(self) -> tuple[str, ...]:
        """Joint names in model order."""
        return tuple(self.verdict["nominal"]["joints"])

    @property
    def effects(self) -> list[dict[str, Any]]:
        """Named and tied effects, strongest first."""
        return self.verdict["effects"]

    @property
    def differing(self) -> tuple[str, ...]:
        """Joints whose residual exceeds what noise explains."""
        return tuple(entry["joint"] for entry in self.verdict["mismatch"]["joints"] if entry["significant"])

    def mismatch(self, joint: str) -> dict[str, Any]:
        """How far the nominal model is from the recording on a joint."""
        return _entry(self.verdict["mismatch"]["joints"], joint)

    def fit(self, joint: str) -> dict[str, Any]:
        """The joint's nMSE on held-out recordings, before and after."""
        return _entry(self.verdict["fit"], joint)

    def unexplained(self, joint: str) -> dict[str, Any]:
        """What the named physics leaves on a joint."""
        return _entry(self.verdict["unexplained"], joint)

    def effects_on(self, joint: str | None) -> list[dict[str, Any]]:
        """Effects of one joint; of the whole arm for None."""
        return [effect for effect in self.effects if effect["joint"] == joint]

    def evidence_on(self, joint: str) -> JointEvidence:
        """The arrays of one joint."""
        return self.evidence.of(joint)


def place(joint: str | None) -> str:
    """Where an effect sits, in words."""
    return WHOLE_ARM if joint is None else joint


def _entry(entries: list[dict[str, Any]], joint: str) -> dict[str, Any]:
    return next((entry for entry in entries if entry["joint"] == joint), {})
