"""Changed links that would have to be denser than any element.

A strut or a balancing spring pulls like a first moment of its link that comes without rotational inertia. As a body
that is much mass close to the axis.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from lagnet.diagnosis.estimation.nearest_body import body_before
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.inertia import least_density


@final
@dataclass(frozen=True)
class ImpossibleDensity(RejectionRule):
    """Mass of the changed link over the volume of its inertia ellipsoid.

    Args:
        most_density: of osmium, the densest element [kg/m³].
        least_growth: mass over that of the modelled link, below which a dense body is the model's own.
    """

    name: ClassVar[str] = "impossible_density"
    statement: ClassVar[str] = "a link as changed is no denser than the densest element"
    source: ClassVar[str] = ""

    most_density: float = 22.6e3
    least_growth: float = 2.0

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        for index, effect in zip(candidate.indices, candidate.effects, strict=True):
            if not effect_named(effect.effect).changes_link:
                continue
            density = self._density(candidate, effect)
            if density > self.most_density:
                detail = f"the link as changed would have at least {1e-3 * density:.3g} times the density of water"
                return (self.rejection(candidate, index, density, self.most_density, detail),)
        return ()

    def _density(self, candidate: Candidate, effect: NamedEffect) -> float:
        """Least density of the changed link [kg/m³]; zero where its mass has not grown."""
        before: np.ndarray = body_before(candidate.problem, effect)
        after = before + effect.body_parameters
        return float(least_density(after)) if after[0] > self.least_growth * before[0] else 0.0
