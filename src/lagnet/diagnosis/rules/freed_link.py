"""Effects that a link's centre makes needless: r = f + Y s π_k beside r = Y Δπ_k with all ten numbers free.

A link whose mass alone is changed has one number, and a link that differs otherwise leaves a torque there that an
offset or a spring of a joint before it resembles. Such an effect was preferred for its few numbers. Where it predicts
blocks of motion no better than all ten numbers of the link do without it, it is not known to be there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar, final

from lagnet.diagnosis.identifiability.selection_odds import odds_over
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.effects.inertia.link_inertia import is_mass_alone


@final
@dataclass(frozen=True)
class FreedLink(RejectionRule):
    """log10 odds of an effect beside a link's mass over all ten numbers of that link without it, complexity aside.

    The least odds are the shared limit of a tie.
    """

    name: ClassVar[str] = "freed_link"
    statement: ClassVar[str] = "an effect beside a link's mass predicts better than all numbers of that link do"
    source: ClassVar[str] = "vuong1989"
    after_refit: ClassVar[bool] = False

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        rejections, least = [], candidate.limits.tie_odds
        for mass, free in _masses(candidate):
            place = candidate.library.hypotheses[mass].joint or 0
            for index in (i for own in candidate.selection.local[: place + 1] for i in own):
                odds = _odds(candidate, index, mass, free)
                if odds < least:
                    detail = f"the centre and inertia of link {place + 1} explain it as well: log10 odds {odds:.2g}"
                    rejections.append(self.rejection(candidate, index, odds, least, detail, (free,)))
        return tuple(sorted(rejections, key=lambda r: r.value))


def _masses(candidate: Candidate) -> Iterator[tuple[int, int]]:
    """Links of which the mass alone is changed, each with the hypothesis of all its ten numbers."""
    hypotheses = candidate.library.hypotheses
    free = {hypotheses[k].place: k for k in candidate.library.reaching if not hypotheses[k].shape}
    for index in candidate.selection.arm_wide:
        h = hypotheses[index]
        if h.law.changes_link and is_mass_alone(dict(h.shape)) and h.place in free:
            yield index, free[h.place]


def _odds(candidate: Candidate, index: int, mass: int, free: int) -> float:
    """log10 odds of the selection over the one without an effect and with all numbers of a link."""
    found = candidate.selection
    instead = tuple(free if i == mass else i for i in found.indices if i != index)
    return odds_over(candidate.equations, found, found.indices, instead, 0.0)
