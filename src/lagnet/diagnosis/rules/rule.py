"""The interface of rejection rules: which selected effects may not be named, by which figure, against which limit."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

from lagnet.diagnosis.rules.candidate import Candidate


@dataclass(frozen=True)
class Rejection:
    """An effect that was considered and is not named.

    Args:
        index: number of its hypothesis in the library.
        effect, joint: name in the catalogue and index of the joint, None for the whole arm.
        rule: name of the rule.
        value, limit: the figure that decided and the limit that it was compared with, in the unit of the statement.
        detail: one sentence that an engineer can check.
        instead: hypotheses that take its place; none in most cases.
    """

    index: int
    effect: str
    joint: int | None
    rule: str
    value: float
    limit: float
    detail: str
    instead: tuple[int, ...] = ()


class RejectionRule(ABC):
    """A statement that must hold of every named effect.

    Final classes are frozen dataclasses whose thresholds are their fields, each with a default and, in the class
    docstring, its meaning. A new rule is one file and one line in `RULES`.
    """

    name: ClassVar[str]
    statement: ClassVar[str]  # what must hold of a named effect
    source: ClassVar[str]  # key in docs/references, or "" where it is our own
    after_refit: ClassVar[bool] = (
        True  # False: judged on the linear fit of the search, before the exact laws are fitted
    )
    after_each_fit: ClassVar[bool] = False  # True: asked again whenever the selection was changed by other means
    together: ClassVar[bool] = (
        False  # True: all that is rejected goes at once; False: the first, then all is judged anew
    )

    @abstractmethod
    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        """The effects of which the statement does not hold, the least useful first; empty where all may stay."""

    def rejection(
        self, candidate: Candidate, index: int, value: float, limit: float, detail: str, instead: tuple[int, ...] = ()
    ) -> Rejection:
        """A rejection of one hypothesis of the candidate by this rule."""
        h = candidate.library.hypotheses[index]
        return Rejection(index, h.effect, h.joint, self.name, float(value), float(limit), detail, instead)
