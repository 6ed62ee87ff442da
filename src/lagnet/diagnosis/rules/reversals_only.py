"""Effects that are the change of sign of dry friction, told in another law: r² falls around reversals and nowhere else.

No dry friction changes its sign in one instant. That of a simulator, solved step by step as a soft constraint, changes
it some milliseconds before or after the speed does, and so do bristles, seals and joints that stick. What is left there
is large, grows with the acceleration of the start, and comes late or early: a delay or a rotor explains it. Both act
between reversals, too, and there an effect that is not there makes the error larger.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from lagnet.diagnosis.regression.normal_equations import left_beside
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.diagnosis.unexplained.localisation import near_reversal
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import NamedEffect

CLEAR = 4.0  # ratio with the others only scaled, beyond which they are not fitted anew


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
            if _as_they_are(candidate, effect, effect.joint) > CLEAR:
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


def _as_they_are(candidate: Candidate, effect: NamedEffect, joint: int) -> float:
    """The ratio where the torques of the others at the joint may be scaled, and no more."""
    between = _between(candidate, joint)
    torques = candidate.torques_at("fit", effect, joint)[between]
    residual = candidate.residual("fit")[between, joint]
    return _ratio(left_beside(torques[:, 1:], residual + torques[:, 0]), residual)


def _ratio_between_reversals(candidate: Candidate, index: int, joint: int) -> float:
    """Squared error without the effect over that with it; infinite where a joint does nothing but turn."""
    between = _between(candidate, joint)
    others = candidate.without(index).effects  # fitted anew: beside the effect they stand for what it gets wrong
    return _ratio(*(candidate.residual("fit", e)[between, joint] for e in (others, None)))


def _between(candidate: Candidate, joint: int) -> np.ndarray:
    """Fitted samples between the changes of direction of a joint, at which it does not rest."""
    return np.concatenate([~near_reversal(p, joint)[p.keep] & p.counts[:, joint] for p in candidate.problem.fit])


def _ratio(without: np.ndarray, with_it: np.ndarray) -> float:
    power = float(with_it @ with_it)
    return float(without @ without) / power if power > 0.0 else np.inf
