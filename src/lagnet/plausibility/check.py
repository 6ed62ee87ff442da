"""What a check is: one statement of physics, held against a model where it is most likely to be broken."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from lagnet.plausibility.subject import Subject

PASS, FAIL, NOT_APPLICABLE = "pass", "fail", "not_applicable"


class NotApplicable(Exception):
    """A check has nothing to say about this model; the message says why."""


@dataclass(frozen=True)
class Finding:
    """The worst that a check found.

    Args:
        value: how far physics is missed there, in the unit of the check.
        where: the place: q, v, a as lists, or joint, link, recording, time.
        detail: one sentence with the numbers that help to mend it.
        limit: where the limit depends on what was found; None for the check's own.
        joints: the value of every joint with its 95 % interval, where the check has one: joint, value, ci95.
    """

    value: float
    where: Mapping[str, Any] = field(default_factory=dict)
    detail: str = ""
    limit: float | None = None
    joints: tuple[Mapping[str, Any], ...] = ()


@dataclass(frozen=True)
class CheckResult:
    """One line of plausibility.json."""

    name: str
    status: str
    value: float | None
    limit: float | None
    unit: str
    where: Mapping[str, Any] | None
    meaning: str
    title: str = ""
    detail: str = ""
    justification: str = ""
    at_least: bool = False
    joints: tuple[Mapping[str, Any], ...] = ()

    @property
    def failed(self) -> bool:
        """Whether the limit is broken."""
        return self.status == FAIL

    def sentence(self) -> str:
        """What is wrong and where, in one line for a terminal."""
        if self.status == NOT_APPLICABLE:
            return f"{self.name}: not applicable, {self.detail}"
        sign = "at least" if self.at_least else "at most"
        unit = f" {self.unit}" if self.unit != "–" else ""
        shown = "not finite" if self.value is None else f"{self.value:.3g}{unit}"
        limit = "" if self.limit is None else f" ({sign} {self.limit:.3g}{unit})"
        return f"{self.name}: {self.detail or self.title}: {shown}{limit}{place(self.where)}"


class Check(ABC):
    """One statement of physics. A variant is a new file in `checks/` and a line in `CHECKS`."""

    name: ClassVar[str]
    title: ClassVar[str]  # what holds, in a few words
    meaning: ClassVar[str]  # one sentence: what it means if it does not
    unit: ClassVar[str] = "–"
    justification: ClassVar[str]  # why the limit is what it is
    at_least: ClassVar[bool] = False  # True: the value must not fall below the limit
    stays_because: ClassVar[str] = ""  # why it is kept although another check sees all that it sees

    @abstractmethod
    def limit(self, subject: Subject) -> float:
        """The value up to which the statement counts as held, for this model's rounding."""

    @abstractmethod
    def find(self, subject: Subject) -> Finding:
        """The worst place found.

        Raises:
            NotApplicable: the model, or what was given beside it, does not allow the check.
        """

    def run(self, subject: Subject) -> CheckResult:
        """The finding held against the limit, or against the user's own limit for this check."""
        try:
            found = self.find(subject)
        except NotApplicable as reason:
            return self.not_applicable(str(reason))
        own = self.limit(subject) if found.limit is None else found.limit
        limit = float(subject.settings.limits.get(self.name, own))
        held = found.value >= limit if self.at_least else found.value <= limit
        value = float(found.value) if np.isfinite(found.value) else None
        result = self._result(PASS if held else FAIL, value, limit, found.where, found.detail)
        return replace(result, joints=found.joints)

    def not_applicable(self, reason: str) -> CheckResult:
        """The result where the check has nothing to say."""
        return self._result(NOT_APPLICABLE, None, None, None, reason)

    def _result(
        self, status: str, value: float | None, limit: float | None, where: Mapping[str, Any] | None, detail: str
    ) -> CheckResult:
        return CheckResult(
            name=self.name,
            status=status,
            value=value,
            limit=limit,
            unit=self.unit,
            where=dict(where) if where else None,
            meaning=self.meaning,
            title=self.title,
            detail=detail,
            justification=self.justification,
            at_least=self.at_least,
        )


def place(where: Mapping[str, Any] | None) -> str:
    """A place in words: "at joint elbow, q = [0.1, 2.3]"."""
    if not where:
        return ""
    words = []
    for name, value in where.items():
        if isinstance(value, list | tuple):
            shown = ", ".join(f"{x:.3g}" if isinstance(x, float) else str(x) for x in value)
            words.append(f"{name} = [{shown}]")
        else:
            shown = f"{value:.6g}" if isinstance(value, float) else str(value)
            words.append(f"{name} {shown} s" if name == "time" else f"{name} {shown}")
    return " at " + ", ".join(words)
