"""Delays that are dry friction changing sign early or late: a delay τ(t − T) acts between reversals, too.

No dry friction changes its sign in one instant. That of a simulator, solved step by step as a soft constraint, changes
it some milliseconds before or after the speed does, and so do bristles and seals.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.diagnosis.unexplained.localisation import near_reversal
from lagnet.effects.catalogue import effect_named


@final
@dataclass(frozen=True)
class ReversalDelay(RejectionRule):
    """Error without the delay, all others fitted anew, over that with it exceeds the shared ratio between reversals."""

    name: ClassVar[str] = "reversal_delay"
    statement: ClassVar[str] = "a delay beside dry friction helps between the changes of direction as well"
    source: ClassVar[str] = ""

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        dry = {e.joint for e in candidate.effects if effect_named(e.effect).is_dry_friction}
        for index, effect in zip(candidate.indices, candidate.effects, strict=True):
            if effect.joint is None or not effect_named(effect.effect).is_delay or effect.joint not in dry:
                continue
            ratio = self._ratio_between_reversals(candidate, index, effect.joint)
            if ratio <= candidate.limits.least_ratio:
                detail = f"between changes of direction the error without it is {ratio:.4g} times that with it"
                return (self.rejection(candidate, index, ratio, candidate.limits.least_ratio, detail),)
        return ()

    def _ratio_between_reversals(self, candidate: Candidate, delay: int, joint: int) -> float:
        between = np.concatenate([~near_reversal(p, joint)[p.keep] for p in candidate.problem.fit])
        others = candidate.without(delay).effects  # fitted anew: beside the delay they stand for what it gets wrong
        with_it, without = (np.sum(candidate.residual("fit", e)[between, joint] ** 2) for e in (None, others))
        return float(without / max(with_it, 1e-300))
