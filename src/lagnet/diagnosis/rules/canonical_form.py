"""Fc⁺[v>0] − Fc⁻[v<0] = Fc s(v) + b: asymmetric friction is reported as Coulomb friction and an offset."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule


@final
@dataclass(frozen=True)
class CanonicalForm(RejectionRule):
    """Fc⁺, −Fc⁻ and Fc s(v) + b are one torque while a joint moves; the pair has the parameters of the literature."""

    name: ClassVar[str] = "canonical_form"
    statement: ClassVar[str] = "asymmetric friction leaves less than Coulomb friction with an offset does"
    source: ClassVar[str] = ""
    after_refit: ClassVar[bool] = False

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        library, least = candidate.library, 1.0 + candidate.limits.least_share
        for joint, own in enumerate(candidate.selection.local):
            for index in own:
                pair, rest = tuple(library.terms_of(index).values()), tuple(i for i in own if i != index)
                if not pair or not all(library.may_stand_beside(k, rest) for k in pair):
                    continue
                other = candidate.without(index, instead=pair).selection
                ratio = other.fit.sse[joint] / max(candidate.selection.fit.sse[joint], 1e-300)
                if ratio < least:
                    detail = (
                        f"Coulomb friction and an offset leave {ratio:.3g} times its squared error and take its place"
                    )
                    return (self.rejection(candidate, index, ratio, least, detail, pair),)
        return ()
