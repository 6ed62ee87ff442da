"""Feed-through of the measured torque: effects computed from it that explain no more than its own noise.

A transmission bends under the torque that it carries, of which the recorded torque is the best estimate. But that
contains its own noise, whose second derivative is much like the noise itself, so that elasticity may seem to explain
noise, or the misspecification of another law. A prediction has no recorded torque: an effect is rejected if it does not
help there, or explains much less there than with the recorded torque.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

from lagnet.diagnosis.problem.residuals import predicted_error
from lagnet.diagnosis.rules.candidate import Candidate, Part
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.effects.catalogue import effect_named


@final
@dataclass(frozen=True)
class MeasuredTorqueLeakage(RejectionRule):
    """An effect that is computed from the measured torque must also help where that torque is not known.

    Args:
        least_kept: share of the error that the effect explains with the measured torque, which it must explain without.
    """

    name: ClassVar[str] = "measured_torque_leakage"
    statement: ClassVar[str] = "an effect of the carried torque helps to predict where no torque was measured"
    source: ClassVar[str] = ""

    least_kept: float = 0.3

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        for index in candidate.indices:
            if not effect_named(candidate.library.hypotheses[index].effect).uses_measured_torque:
                continue
            less = candidate.without(index)
            for part in ("holdout", "fit"):
                found = self._idle(candidate, less, part, index)
                if found:
                    return (found,)
        return ()

    def _idle(self, candidate: Candidate, less: Candidate, part: Part, index: int) -> Rejection | None:
        """A rejection where these segments are predicted as well by the selection that has one effect less."""
        problem, segments, fits = candidate.problem, candidate.segments(part), (less, candidate)
        without, with_it = (predicted_error(problem, segments, c.effects) for c in fits)
        ratio = without / max(with_it, 1e-300)
        if without < candidate.limits.least_ratio * with_it:
            detail = f"without it the torque is predicted with {ratio:.4g} times the error"
            return self.rejection(candidate, index, ratio, candidate.limits.least_ratio, detail)
        known = [predicted_error(problem, segments, c.effects, measured_torque=True) for c in fits]
        kept = (without - with_it) / max(known[0] - known[1], 1e-300)
        if without - with_it < self.least_kept * (known[0] - known[1]):
            detail = f"where no torque is measured it explains {kept:.3g} of what it explains with the measured torque"
            return self.rejection(candidate, index, kept, self.least_kept, detail)
        return None
