"""Bodies whose centre of mass would lie far outside of the link: c = (m c) / m beyond twice its length.

Where motion leaves a mass open, a first moment that is well known gives any centre; and a strut or a counterweight
pulls like a first moment that no link can have.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np

from lagnet.diagnosis.estimation.nearest_body import body_before
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import NamedEffect


@final
@dataclass(frozen=True)
class DistantCentre(RejectionRule):
    """Distance of the changed link's centre of mass from its joint over the length of the link.

    The length is that to the next joint, and at least the mean of the arm and the modelled distance of the centre.

    Args:
        most_lengths: a centre outside of the link by its own length.
    """

    name: ClassVar[str] = "distant_centre"
    statement: ClassVar[str] = "a link as changed has its centre of mass within twice its length"
    source: ClassVar[str] = ""

    most_lengths: float = 2.0

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        lengths = link_lengths(candidate.problem.nominal)
        for index, effect in zip(candidate.indices, candidate.effects, strict=True):
            if effect.joint is None or lengths is None or not effect_named(effect.effect).changes_link:
                continue
            distance, length = self._distance(candidate, effect, lengths)
            if not distance <= self.most_lengths * length:
                detail = (
                    f"the link as changed would have its centre of mass {distance:.3g} m off its joint, "
                    f"{distance / length:.3g} times its length"
                )
                return (self.rejection(candidate, index, distance / length, self.most_lengths, detail),)
        return ()

    def _distance(self, candidate: Candidate, effect: NamedEffect, lengths: np.ndarray) -> tuple[float, float]:
        """|c| of the changed link and the length that it is compared with [m]; infinite |c| where no mass is left."""
        before: np.ndarray = body_before(candidate.problem, effect)
        after = before + effect.body_parameters
        modelled = np.linalg.norm(before[1:4]) / before[0] if before[0] > 0 else 0.0
        length = float(max(lengths[effect.joint], lengths.mean(), modelled))
        return (float(np.linalg.norm(after[1:4]) / after[0]) if after[0] > 0 else float("inf")), length


def link_lengths(model: Any) -> np.ndarray | None:
    """Distance of each joint from the next, the last one's from the tip, shape (dof,) [m].

    None where a model tells no places of its joints, or has all of them in one place.
    """
    if not hasattr(model, "skeleton"):
        return None
    lengths = np.linalg.norm(np.diff(model.skeleton(np.zeros(model.n_dof)), axis=0), axis=1)[1:]
    return lengths if lengths.mean() > 0 else None
