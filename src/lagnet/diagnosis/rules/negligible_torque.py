"""Effects whose torque, fitted by the exact law, is too small to be claimed or not significantly different from 0."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from lagnet.diagnosis.estimation.gauss_newton import spread
from lagnet.diagnosis.estimation.superposition import Superposition, reduced
from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.needed_body import is_open
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import NamedEffect

SILENT = 1e-3  # of the least power that is claimed: the others fit as well without it
UNDETERMINED = 1e-9  # weight of an effect whose intervals all hold the value of its absence: it goes before all others


@final
@dataclass(frozen=True)
class NegligibleTorque(RejectionRule):
    """Power of the effect's torque, over min(max(t² var τ, r mean r²), left), exceeds one at some joint.

    t and r are shared limits, r the residual of the nominal model, `left` the power of what all effects leave. Beside a
    cause that makes the nominal model almost all wrong, a share of that error is much: an effect that explains more
    than all that is left there is none to be passed over. That holds of laws whose torque is like no load's; a share
    of the load, or a body, may stand for a part of the large cause, and `left` does not count for it.

    A law whose interval holds its absence gives its place to its special case: a spring to an offset.
    """

    name: ClassVar[str] = "negligible_torque"
    statement: ClassVar[str] = (
        "the torque of the effect is large enough to be claimed, and its interval leaves out zero"
    )
    source: ClassVar[str] = ""
    after_each_fit: ClassVar[bool] = True
    together: ClassVar[bool] = True

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        sizes = self.sizes(candidate.problem, candidate.effects, candidate.sigma**2)
        undetermined = [is_open(candidate, n, intervals) for n, intervals in enumerate(candidate.refit.intervals)]
        ranked = [s * UNDETERMINED if u else s for s, u in zip(sizes, undetermined, strict=True)]
        small = sorted((n for n, size in enumerate(ranked) if size < 1.0), key=lambda n: ranked[n])
        silent = [n for n in small if sizes[n] < SILENT]  # without these nothing changes; else one at a time
        return tuple(self._rejection(candidate, n, sizes[n], undetermined[n]) for n in silent or small[:1])

    def _rejection(self, candidate: Candidate, n: int, size: float, undetermined: bool) -> Rejection:
        index, detail = candidate.indices[n], f"the power of its torque is {size:.3g} times the least that is claimed"
        if not undetermined:
            return self.rejection(candidate, index, size, 1.0, detail)
        instead = special_case(candidate, index)
        detail = "its 95 % interval holds the value at which it would be absent"
        detail += "".join(f"; {candidate.library.hypotheses[i].effect} takes its place" for i in instead)
        return self.rejection(candidate, index, size, 1.0, detail, instead)

    @staticmethod
    def sizes(problem: Problem, effects: Sequence[NamedEffect], left: np.ndarray | float = np.inf) -> list[float]:
        """Power of each effect's torque over the least that may be claimed, at the joint where it is largest.

        Args:
            left: shape (dof,), mean square of what all effects leave, noise at least [N² m²].
        """
        pieces = spread(problem.fit)
        motions = [p.motion(problem) for p in pieces]
        sums = [Superposition(m, effects) for m in motions]
        nominal = _mean_square([problem.residual(p) for p in pieces])
        out = []
        for n, effect in enumerate(effects):
            parts = [reduced(problem, p, s.without(n)) for p, s in zip(pieces, sums, strict=True)]
            least = problem.limits.least_power_of(effect_named(effect.effect), problem.scale**2, nominal, left)
            out.append(float(np.max(_mean_square(parts) / least)))
        return out


def special_case(candidate: Candidate, index: int) -> tuple[int, ...]:
    """The hypothesis that a selected one contains and that nothing else selected excludes; none in most cases.

    A spring whose rest position is far away is an offset, and has a stiffness that may be zero.
    """
    library, chosen = candidate.library, candidate.library.hypotheses[index]
    if chosen.joint is None:
        return ()
    others = {*candidate.selection.local[chosen.joint]} - {index}
    simple = (i for i in library.local[chosen.joint] if library.hypotheses[i].effect in chosen.law.contains)
    return tuple(i for i in simple if library.may_stand_beside(i, others))[:1]


def _mean_square(parts: list[np.ndarray]) -> np.ndarray:
    return np.mean(np.concatenate(parts) ** 2, axis=0)
