"""Effects that are not significant under misspecification.

Where a law is not quite that of the joint, its residual resembles a little of another law: a delay that fits the slow
half of the motion, but not the fast half. An effect whose 95 % intervals, widened by the disagreement between parts of
the motion (Hausman 1978), contain the values at which it would be absent, is not claimed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

from lagnet.diagnosis.estimation.intervals.misspecification import interval_errors, widened
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.needed_body import is_open
from lagnet.diagnosis.rules.negligible_torque import NegligibleTorque
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.effects.catalogue import effect_named


@final
@dataclass(frozen=True)
class NotSignificant(RejectionRule):
    """Some 95 % interval, widened by the misspecification of the law, leaves out the value of the effect's absence."""

    name: ClassVar[str] = "not_significant"
    statement: ClassVar[str] = "the interval of the effect, parts of the motion compared, leaves out its absence"
    source: ClassVar[str] = "hausman1978"

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        effects = candidate.effects
        if not effects:
            return ()
        errors = interval_errors(candidate.problem, effects, candidate.sigma)
        wide = [widened(*pair) for pair in zip(candidate.refit.intervals, errors, strict=True)]
        not_determined = [n for n, intervals in enumerate(wide) if is_open(candidate, n, intervals)]
        if not not_determined:
            return ()
        sizes = NegligibleTorque.sizes(candidate.problem, effects)
        return tuple(self._rejection(candidate, n, wide[n]) for n in sorted(not_determined, key=lambda n: sizes[n]))

    def _rejection(self, candidate: Candidate, n: int, interval: dict[str, tuple[float, float]]) -> Rejection:
        (name, absent), *_ = effect_named(candidate.effects[n].effect).absence
        low, high = interval[name]
        detail = f"parts of the motion disagree on it: {name} lies between {low:.3g} and {high:.3g}"
        nearest = min(abs(absent - low), abs(high - absent))
        return self.rejection(candidate, candidate.indices[n], nearest, 0.0, detail)
