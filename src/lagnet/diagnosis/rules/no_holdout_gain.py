"""Effects that do not lower the error of recordings that were not fitted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule


@final
@dataclass(frozen=True)
class NoHoldoutGain(RejectionRule):
    """Held-out nMSE without the effect over that with it, the others refitted, exceeds the shared ratio."""

    name: ClassVar[str] = "no_holdout_gain"
    statement: ClassVar[str] = "the held-out error without the effect is larger than with it"
    source: ClassVar[str] = ""
    after_refit: ClassVar[bool] = False

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        ratios = {i: p.without / max(p.with_it, 1e-300) for i, p in candidate.holdout_gain.items()}
        useless = sorted((i for i, r in ratios.items() if r <= candidate.limits.least_ratio), key=lambda i: ratios[i])
        return tuple(self._rejection(candidate, i, ratios[i]) for i in useless)

    def _rejection(self, candidate: Candidate, index: int, ratio: float) -> Rejection:
        detail = f"without it the held-out error is {ratio:.4g} times that with it"
        return self.rejection(candidate, index, ratio, candidate.limits.least_ratio, detail)
