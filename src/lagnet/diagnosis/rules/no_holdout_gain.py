"""Effects that do not lower the error of recordings that were not fitted: alone, two together, or all of a joint.

A cable that goes taut is fitted by a spring and a wrong link, which cancel each other where it is slack. In held-out
motion where it is slack all the time each of them makes good the error of the other, and neither is needed. Three may
cancel each other where no two do.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.diagnosis.selection.holdout_gain import of_one_joint, opposed_pairs, ratio_without


@final
@dataclass(frozen=True)
class NoHoldoutGain(RejectionRule):
    """Held-out nMSE without the effect over that with it, the others refitted, exceeds the shared ratio.

    So does that without two effects whose torques oppose each other, at some joint, and that without all of a joint.
    """

    name: ClassVar[str] = "no_holdout_gain"
    statement: ClassVar[str] = "the held-out error without the effect is larger than with it"
    source: ClassVar[str] = ""
    after_refit: ClassVar[bool] = False

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        ratios = {i: p.without / max(p.with_it, 1e-300) for i, p in candidate.holdout_gain.items()}
        useless = sorted((i for i, r in ratios.items() if r <= candidate.limits.least_ratio), key=lambda i: ratios[i])
        alone = tuple(self._rejection(candidate, i, ratios[i], "it") for i in useless)
        return alone or self._together(candidate)

    def _together(self, candidate: Candidate) -> tuple[Rejection, ...]:
        """All of the first group of effects that are of use to each other alone."""
        fitted, unseen, found = candidate.equations, candidate.holdout_equations, candidate.selection
        for group in (*opposed_pairs(unseen, found), *of_one_joint(unseen, found)):
            if any(candidate.holdout_gain[i].silent for i in group):
                continue
            ratio = ratio_without(fitted, unseen, found, group, candidate.sigma)
            if ratio <= candidate.limits.least_ratio:
                names = {i: candidate.library.hypotheses[i].effect for i in group}
                others = {i: " and ".join(n for k, n in names.items() if k != i) for i in group}
                return tuple(self._rejection(candidate, i, ratio, f"it and {others[i]}") for i in group)
        return ()

    def _rejection(self, candidate: Candidate, index: int, ratio: float, without: str) -> Rejection:
        detail = f"without {without} the held-out error is {ratio:.4g} times that with {without}"
        return self.rejection(candidate, index, ratio, candidate.limits.least_ratio, detail)
