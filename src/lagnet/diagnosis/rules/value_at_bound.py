"""Values that ended at the limit of what is searched: the cause is another, or the data are.

A torque logged 0.4 s late gives a delay of exactly the largest that is searched; the figure then says nothing of the
arm. Zero is no such limit: there an effect is absent, which other rules judge.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.effects.catalogue import effect_named
from lagnet.effects.effect import Parameter
from lagnet.models.corrected.named_effects import NamedEffect


@final
@dataclass(frozen=True)
class ValueAtBound(RejectionRule):
    """Distance of each value from the bounds of its parameter, over their distance from each other.

    Args:
        least_distance: as a share of the range that is searched.
    """

    name: ClassVar[str] = "value_at_bound"
    statement: ClassVar[str] = "no value ended at the limit of what is searched"
    source: ClassVar[str] = ""

    least_distance: float = 1e-3

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        for index, effect in zip(candidate.indices, candidate.effects, strict=True):
            for parameter in effect_named(effect.effect).free_parameters:
                distance, bound = distance_to_bound(effect, parameter)
                if distance < self.least_distance:
                    detail = (
                        f"{parameter.symbol} ended at {bound:.4g} {parameter.unit}, the limit of what is searched: the "
                        "effect is larger than any such or is another, and the value says nothing"
                    )
                    return (self.rejection(candidate, index, distance, self.least_distance, detail),)
        return ()


def distance_to_bound(effect: NamedEffect, parameter: Parameter) -> tuple[float, float]:
    """Distance of a value from the nearer bound that is not zero, as a share of the range, and that bound.

    Infinite where a parameter has no range or the effect no such value.
    """
    value, extent = effect.values.get(parameter.name), parameter.upper - parameter.lower
    bounds = [b for b in (parameter.lower, parameter.upper) if np.isfinite(b) and b]
    if value is None or not np.isfinite(extent) or not bounds:
        return float("inf"), float("nan")
    nearest = min(bounds, key=lambda b: abs(value - b))
    return abs(value - nearest) / extent, nearest
