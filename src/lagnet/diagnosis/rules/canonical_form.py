"""Fc⁺[v>0] − Fc⁻[v<0] = Fc s(v) + b: asymmetric friction is reported as Coulomb friction and an offset."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule

COULOMB, OFFSET, ASYMMETRIC = "coulomb_friction", "torque_offset", "asymmetric_friction"


@final
@dataclass(frozen=True)
class CanonicalForm(RejectionRule):
    """Fc⁺, −Fc⁻ and Fc s(v) + b are one torque while a joint moves; the pair has the parameters of the literature."""

    name: ClassVar[str] = "canonical_form"
    statement: ClassVar[str] = "asymmetric friction leaves less than Coulomb friction with an offset does"
    source: ClassVar[str] = ""
    after_refit: ClassVar[bool] = False

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        library = candidate.library
        for joint, own in enumerate(candidate.selection.local):
            plain = {library.hypotheses[i].effect: i for i in library.local[joint] if not library.hypotheses[i].shape}
            pair = tuple(plain[n] for n in (COULOMB, OFFSET) if n in plain)
            asymmetric = plain.get(ASYMMETRIC)
            if asymmetric not in own or len(pair) < 2 or any(self._has_offset(candidate, i) for i in own):
                continue
            other = candidate.without(asymmetric, instead=pair).selection
            ratio = other.fit.sse[joint] / max(candidate.selection.fit.sse[joint], 1e-300)
            if ratio < 1.0 + candidate.limits.least_share:
                detail = f"Coulomb friction and an offset leave {ratio:.3g} times its squared error and take its place"
                return (self.rejection(candidate, asymmetric, ratio, 1.0 + candidate.limits.least_share, detail, pair),)
        return ()

    @staticmethod
    def _has_offset(candidate: Candidate, index: int) -> bool:
        law = candidate.library.hypotheses[index].law
        return OFFSET in (law.name, *law.contains)
