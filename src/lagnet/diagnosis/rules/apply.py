"""Elimination: rules are applied to a selection until none rejects, and every rejection is kept with its reason."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule


@dataclass(frozen=True, eq=False)
class Eliminated:
    """The remaining candidate, and all rejections in their order."""

    candidate: Candidate
    rejected: tuple[Rejection, ...]


def apply_rules(rules: Sequence[RejectionRule], candidate: Candidate) -> Eliminated:
    """The candidate without all effects that some rule rejects, refitted after every rejection.

    Rules on the linear fit of the search come first, each until it rejects nothing more. Then come those on the refit
    by the exact laws: after each rejection all of them are applied again from the first, since without one effect
    another may become necessary or superfluous.
    """
    gone: list[Rejection] = []
    for rule in (r for r in rules if not r.after_refit):
        while found := rule.rejected(candidate):
            candidate = _without(rule, candidate, found, gone)
    exact = [r for r in rules if r.after_refit]
    while True:
        for rule in exact:
            if found := rule.rejected(candidate):
                candidate = _without(rule, candidate, found, gone)
                break
        else:
            return Eliminated(candidate, tuple(gone))


def _without(rule: RejectionRule, candidate: Candidate, found: Sequence[Rejection], gone: list[Rejection]) -> Candidate:
    taken = tuple(found) if rule.together else tuple(found[:1])
    gone.extend(taken)
    return candidate.without(*(r.index for r in taken), instead=tuple(i for r in taken for i in r.instead))
