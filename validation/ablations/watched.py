"""What had an effect in a whole diagnosis: rules that rejected, steps that changed something, limits that decide.

A rule that rejected nothing wherever it was asked, in reruns too, leaves the same verdict behind when it is left out,
since without it the same questions follow one another. So does a step that gave back, each time, what its neutral gives
back, and a limit of a rule at another value with which the rule rejects the same each time.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from validation.ablations.table import Ablation
from validation.ablations.taken_out import Instead


@dataclass
class Effects:
    """Rules that rejected, places that changed something, ablations whose changed rules decide otherwise."""

    rules: set[str] = field(default_factory=set)
    places: set[str] = field(default_factory=set)
    changed_rules: set[str] = field(default_factory=set)

    def to_json(self) -> dict[str, list[str]]:
        """Plain values."""
        return {name: sorted(found) for name, found in vars(self).items()}

    @classmethod
    def from_json(cls, kept: dict[str, list[str]]) -> Effects:
        """What `to_json` gave."""
        return cls(**{name: set(found) for name, found in kept.items()})

    def of(self, ablation: Ablation) -> bool:
        """Whether the verdict may be another under an ablation; True where it was not watched."""
        if ablation.limits is not None or any(p not in WATCHED for p in ablation.instead):
            return True
        decides = ablation.changed and ablation.name in self.changed_rules
        return bool(self.rules & ablation.less or self.places & ablation.instead.keys() or decides)


WATCHED = frozenset(
    {
        "lagnet.diagnosis.nominal.mounting:mounting_of",
        "lagnet.diagnosis.selection.residual_proposals:proposals_from_residual",
        "lagnet.diagnosis.identifiability.ambiguity:ambiguous_causes",
        "lagnet.diagnosis.estimation.physical_bodies:with_physical_bodies",
        "lagnet.diagnosis.estimation.friction_at_rest:friction_at_rest",
        "lagnet.diagnosis.reruns.band:best_band",
        "lagnet.diagnosis.reruns.clock:on_one_clock",
        "lagnet.diagnosis.reruns.transients:settle_transients",
    }
)
"""Places whose neutral costs nothing, so that it can be asked beside the step."""


def watched_places(ablations: Sequence[Ablation], seen: Effects) -> Instead:
    """In each watched place the step itself, which notes where its neutral would give back something else."""
    neutrals = {place: new for a in ablations for place, new in a.instead.items() if place in WATCHED}
    return {place: _beside(place, new, seen) for place, new in neutrals.items()}


def _beside(place: str, neutral: Callable, seen: Effects) -> Callable[[Callable], Callable]:
    def wrap(old: Callable) -> Callable:
        idle = neutral(old)

        def step(*given: Any, **more: Any) -> Any:
            result = old(*given, **more)
            if place not in seen.places and not _same(result, idle(*given, **more)):
                seen.places.add(place)
            return result

        return step

    return wrap


def _same(one: Any, other: Any) -> bool:
    if one is other:
        return True
    if isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        return np.array_equal(one, other)
    return type(one) is type(other) and isinstance(one, (tuple, dict)) and not one and not other


class WatchedRule(RejectionRule):
    """A rule that notes whether it rejects, and which changed limits of its own would reject otherwise."""

    def __init__(self, rule: RejectionRule, changed: dict[str, RejectionRule], seen: Effects) -> None:
        self.rule, self.changed, self.seen = rule, changed, seen
        for told in ("name", "statement", "source", "after_refit", "after_each_fit", "together"):
            setattr(self, told, getattr(rule, told))

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        """What the rule rejects."""
        found = self.rule.rejected(candidate)
        self.seen.rules.update({self.rule.name} if found else ())
        for ablation, other in self.changed.items():
            if ablation not in self.seen.changed_rules and self._taken(other.rejected(candidate)) != self._taken(found):
                self.seen.changed_rules.add(ablation)
        return found

    def _taken(self, found: Sequence[Rejection]) -> list[tuple[int, tuple[int, ...]]]:
        """What a rejection does to the selection."""
        return [(r.index, r.instead) for r in (found if self.rule.together else found[:1])]


def watched_rules(rules: Sequence[RejectionRule], ablations: Sequence[Ablation], seen: Effects) -> list[WatchedRule]:
    """The rules, watched; with those of the ablations that change a limit of a rule."""
    changed = {(r.name, a.name): r for a in ablations for r in a.changed}
    return [WatchedRule(r, {a: c for (name, a), c in changed.items() if name == r.name}, seen) for r in rules]
