"""Small effects at single joints that are nearly collinear with arm-wide effects.

A gain of one per cent beside a payload may only compensate an error of the payload's coefficients, which were fitted
beside it. Small effects that may be confused with arm-wide ones are rejected where the arm-wide effects, refitted
without them, leave a squared error that is hardly larger.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, final

import numpy as np

from lagnet.diagnosis.regression.cross_validation import NormalEquations
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.diagnosis.selection.arm_search import Selection, noticeable, refit_selection, views_of
from lagnet.diagnosis.selection.joint_search import JointView
from lagnet.percent import percent

Local = tuple[tuple[int, ...], ...]


@final
@dataclass(frozen=True)
class CollinearWithBody(RejectionRule):
    """Share of the joint's mismatch that the effect explains beside all others.

    Args:
        least_share: of the mismatch.
        most_error: squared error without them over that with them, or over the noise, above which they stay.
    """

    name: ClassVar[str] = "collinear_with_body"
    statement: ClassVar[str] = "an effect that resembles an arm-wide one explains a part of its own of the joint"
    source: ClassVar[str] = ""
    after_refit: ClassVar[bool] = False
    together: ClassVar[bool] = True

    least_share: float = 0.05
    most_error: float = 4.0

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        equations, found = candidate.equations, candidate.selection
        kept = self._kept(equations, found)
        gone = [(i, j) for j, own in enumerate(found.local) for i in own if i not in kept[j]]
        return tuple(self._rejection(candidate, i, views_of(equations, found)[j]) for i, j in gone)

    def _rejection(self, candidate: Candidate, index: int, view: JointView) -> Rejection:
        share = _share(view, candidate.selection.local[view.joint], index)
        detail = f"beside the bodies it explains {percent(share)} of its joint, and without it hardly more is left"
        return self.rejection(candidate, index, share, self.least_share, detail)

    def _kept(self, equations: NormalEquations, best: Selection) -> Local:
        """For each joint the effects that stay."""
        local = self._large(equations, best) if best.arm_wide else best.local
        while local != best.local:
            plain = refit_selection(equations, replace(best, local=local))
            grown = plain.fit.sse > self.most_error * np.maximum(best.fit.sse, best.scales.noise_power)
            worse = grown | noticeable(equations, plain.scales, plain.fit.sse, best.fit.sse)
            restored = tuple(best.local[j] if bad else local[j] for j, bad in enumerate(worse))
            if restored == local:
                return local if not worse.any() else best.local
            local = restored
        return best.local

    def _large(self, equations: NormalEquations, found: Selection) -> Local:
        """The effects of each joint that explain more than the least share, or resemble no arm-wide effect."""
        laws = [equations.library.hypotheses[i].law for i in found.arm_wide]

        def confused(index: int) -> bool:
            own = equations.library.hypotheses[index].law
            return any(own.name in law.confused_with or law.name in own.confused_with for law in laws)

        def kept(view: JointView, own: tuple[int, ...]) -> tuple[int, ...]:
            return tuple(i for i in own if not confused(i) or _share(view, own, i) > self.least_share)

        return tuple(kept(view, own) for view, own in zip(views_of(equations, found), found.local, strict=True))


def _share(view: JointView, own: Sequence[int], index: int) -> float:
    """(E without the effect − E) / Σ r²: share of the joint's mismatch that one of its effects explains."""
    gain = view.error([k for k in own if k != index]) - view.error(own)
    return gain / max(float(view.equations.total[view.joint][-1, -1]), 1e-300)
