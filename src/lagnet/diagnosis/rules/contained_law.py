"""(Fc + Fs exp(−(v/vs)²)) s(v) with Fs = 0 is Fc s(v): a law whose further term vanishes is the plainer one.

A term that vanishes at every sample that counts was not seen, however large its parameter: friction that rises at a
third of the slowest recorded speed is what other causes do around reversals.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.effects.catalogue import effect_named


@final
@dataclass(frozen=True)
class ContainedLaw(RejectionRule):
    """Largest size of a law's further term at samples that count, over the rest of it.

    It must exceed the least share: else the law without that term stands.

    Args:
        least_share: that the further term must have.
    """

    name: ClassVar[str] = "contained_law"
    statement: ClassVar[str] = "no term of the law vanishes, without which it is a plainer one"
    source: ClassVar[str] = ""
    after_each_fit: ClassVar[bool] = True

    least_share: float = 0.01

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        hypotheses = candidate.library.hypotheses
        for index, effect in zip(candidate.indices, candidate.effects, strict=True):
            if effect.joint is None:
                continue
            further = effect_named(effect.effect).further_term(effect.values, _seen(candidate.problem, effect.joint))
            if further is None or further[1] >= self.least_share:
                continue
            plain, share = further
            others = candidate.library.local[effect.joint]
            place = tuple(i for i in others if hypotheses[i].effect == plain and not hypotheses[i].shape)
            if place:
                detail = f"its further term is {share:.2g} of the rest, and {plain.replace('_', ' ')} takes its place"
                return (self.rejection(candidate, index, share, self.least_share, detail, place[:1]),)
        return ()


def _seen(problem: Problem, joint: int) -> np.ndarray:
    """Speeds of a joint at fitted samples that count, shape (n,) [rad/s]."""
    return np.concatenate([p.v[p.keep][p.counts[:, joint], joint] for p in problem.fit])
