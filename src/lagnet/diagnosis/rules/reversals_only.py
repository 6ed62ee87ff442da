"""Effects that are the change of sign of dry friction, told in another law: r² falls around reversals and nowhere else.

No dry friction changes its sign in one instant. That of a simulator, solved step by step as a soft constraint, changes
it some milliseconds before or after the speed does, and so do bristles, seals and joints that stick. What is left there
is large, grows with the acceleration of the start, and comes late or early: a delay or a rotor explains it. Both act
between reversals, too, and there an effect that is not there makes the error larger.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from lagnet.diagnosis.problem.problem import Segment
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.diagnosis.unexplained.localisation import near_reversal
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import NamedEffect

CLEAR = 2.0  # ratio along the tangent of the fit, beyond which the others are not fitted anew by their exact laws


@final
@dataclass(frozen=True)
class ReversalsOnly(RejectionRule):
    """Error without the effect, all others fitted anew, over that with it exceeds the shared ratio between reversals.

    Asked of effects of one joint that act whenever it moves: not of dry friction itself, backlash, flexible joints and
    the limit of a torque, which may have their say where the joint turns.
    """

    name: ClassVar[str] = "reversals_only"
    statement: ClassVar[str] = "an effect beside dry friction helps between the changes of direction as well"
    source: ClassVar[str] = ""

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        dry = {e.joint for e in candidate.effects if effect_named(e.effect).is_dry_friction}
        for index, effect in zip(candidate.indices, candidate.effects, strict=True):
            if effect.joint is None or effect.joint not in dry or not acts_throughout(effect):
                continue
            if _along_the_tangent(candidate, index, effect.joint) > CLEAR:
                continue
            ratio = _ratio_between_reversals(candidate, index, effect.joint)
            if ratio <= candidate.limits.least_ratio:
                detail = f"between changes of direction the error without it is {ratio:.4g} times that with it"
                return (self.rejection(candidate, index, ratio, candidate.limits.least_ratio, detail),)
        return ()


def acts_throughout(effect: NamedEffect) -> bool:
    """Whether an effect of one joint acts whenever the joint moves, whatever its direction did before."""
    law = effect_named(effect.effect)
    turns = law.is_dry_friction or law.is_limit or not (law.instantaneous or law.is_delay)
    return not (turns or law.reaches_all)


def _along_the_tangent(candidate: Candidate, index: int, joint: int) -> float:
    """The ratio where the others are fitted anew to first order."""
    fit = candidate.left_out
    rows = [_between([piece], joint) for piece in fit.pieces]
    parts = (fit.without(candidate.indices.index(index)), fit.residuals)
    return _ratio(*(np.concatenate([e[r, joint] for e, r in zip(part, rows, strict=True)]) for part in parts))


def _ratio_between_reversals(candidate: Candidate, index: int, joint: int) -> float:
    """Squared error without the effect over that with it; infinite where a joint does nothing but turn."""
    between = _between(candidate.problem.fit, joint)
    others = candidate.without(index).effects  # fitted anew: beside the effect they stand for what it gets wrong
    return _ratio(*(candidate.residual("fit", e)[between, joint] for e in (others, None)))


def _between(pieces: Sequence[Segment], joint: int) -> np.ndarray:
    """Samples between the changes of direction of a joint, at which it does not rest."""
    return np.concatenate([~near_reversal(p, joint)[p.keep] & p.counts[:, joint] for p in pieces])


def _ratio(without: np.ndarray, with_it: np.ndarray) -> float:
    power = float(with_it @ with_it)
    return float(without @ without) / power if power > 0.0 else np.inf
