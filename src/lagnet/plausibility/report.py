"""What the suite found, and how it is put into plausibility.json."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from lagnet.files import write_whole
from lagnet.plausibility.check import FAIL, NOT_APPLICABLE, PASS, CheckResult


@dataclass(frozen=True)
class PlausibilityReport:
    """The results of all checks, in the order of CHECKS.

    Args:
        checks: one result a check.
        joints: joint names of the model.
    """

    checks: tuple[CheckResult, ...]
    joints: tuple[str, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether no check failed."""
        return not self.failures

    @property
    def failures(self) -> tuple[CheckResult, ...]:
        """The failed checks, the most basic first."""
        return tuple(c for c in self.checks if c.status == FAIL)

    def __getitem__(self, name: str) -> CheckResult:
        """The result of one check by name."""
        return next(c for c in self.checks if c.name == name)

    def headline(self) -> str:
        """One line: what is wrong and where, or that nothing is."""
        if not self.failures:
            held = sum(c.status == PASS for c in self.checks)
            return f"PASS {held} checks passed, {self._count(NOT_APPLICABLE)} not applicable"
        more = len(self.failures) - 1
        rest = f"; {more} more failed: {', '.join(c.name for c in self.failures[1:])}" if more else ""
        return f"FAIL {self.failures[0].sentence()}{rest}"

    def to_json(self) -> str:
        """The list of checks as JSON; numbers that are not finite become null."""
        return (
            json.dumps([_plain(asdict(c)) for c in self.checks], indent=1, allow_nan=False, ensure_ascii=False) + "\n"
        )

    def write(self, path: str | Path) -> Path:
        """Write plausibility.json in one step, so that an interrupted run leaves no half of it."""
        return write_whole(path, self.to_json())

    def _count(self, status: str) -> int:
        return sum(c.status == status for c in self.checks)


def _plain(node: Any) -> Any:
    if isinstance(node, dict):
        return {str(name): _plain(value) for name, value in node.items()}
    if isinstance(node, list | tuple):
        return [_plain(value) for value in node]
    if hasattr(node, "tolist"):
        return _plain(node.tolist())
    if isinstance(node, float):
        return node if math.isfinite(node) else None
    return node
