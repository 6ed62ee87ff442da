"""log10 odds = (log P(S) − log P(S with a rival)) / ln 10 of every named effect, and ties where they are too small."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.identifiability.block_odds import held_out_errors, log10_odds
from lagnet.diagnosis.identifiability.selection_odds import odds_over
from lagnet.diagnosis.regression.cross_validation import NormalEquations
from lagnet.diagnosis.selection.arm_search import Selection, total_score, views_of
from lagnet.diagnosis.selection.joint_view import JointView, compatible

SHOWN = 6  # rivals that the evidence lists
REST = 0.5  # of what a law leaves above the noise, that a wider one may leave to account for it


@dataclass(frozen=True)
class Comparison:
    """One selected hypothesis and its rivals.

    Args:
        index: the hypothesis.
        rivals: effect names with the log10 odds of the selected one over each, closest first.
        tied: names that the data do not distinguish from it.
        elsewhere: joints whose link, changed in its place, the data do not distinguish from it.
    """

    index: int
    rivals: tuple[tuple[str, float], ...]
    tied: tuple[str, ...]
    elsewhere: tuple[int, ...] = ()

    @property
    def best_rival(self) -> tuple[str | None, float | None]:
        """The closest rival and the log10 odds over it; None where there is none."""
        return self.rivals[0] if self.rivals else (None, None)


def compare_with_rivals(equations: NormalEquations, found: Selection) -> tuple[Comparison, ...]:
    """Compares each selected hypothesis with every replacement in its place."""
    views = views_of(equations, found)
    comparisons = [_arm_wide_comparison(equations, found, i) for i in found.arm_wide]
    for joint, own in enumerate(found.local):
        comparisons.extend(_local_comparison(views[joint], own, i) for i in own)
    return tuple(comparisons)


def _local_comparison(view: JointView, own: tuple[int, ...], index: int) -> Comparison:
    here, error = view.score(own), view.error(own)
    closest: dict[str, tuple[float, tuple[int, ...]]] = {}
    tied: set[str] = set()
    for names, other in replacements(view, own, index):
        score = view.score(other)
        if not np.isfinite(score):
            continue
        gap = here - score
        same = view.error(other) - error < max(view.limits.same_error * error, view.least_gain)
        for name in names:
            if name not in closest or gap < closest[name][0]:
                closest[name] = gap, other
            if same:
                tied.add(name)
    odds = {name: _local_odds(view, own, other) for name, (_, other) in closest.items()}
    tied.update(name for name, told in odds.items() if told < view.limits.tie_odds)
    tied.update(_open_to(view, own, index))
    return Comparison(index, _ranked(odds), tuple(sorted(tied)))


def _local_odds(view: JointView, own: tuple[int, ...], other: tuple[int, ...]) -> float:
    """log10 odds of a joint's selection over another: of their errors in blocks, and of their complexity."""
    system = view.system
    here, there = (held_out_errors(system.blocks, system.folds, system.columns(s))[None] for s in (own, other))
    simpler = sum(view.equations.penalties[list(other)]) - sum(view.equations.penalties[list(own)])
    return log10_odds([view.pieces], here, there, [view.least_error], float(simpler))


def _open_to(view: JointView, own: tuple[int, ...], index: int) -> set[str]:
    """All wider laws whose further term may be there, each at the shape that the evidence likes best.

    Where the evidence prefers one the search refused it: at the least shape that was tried (a Stribeck speed this close
    to the zone that noise blurs could be the blur itself), or as too little beside what the plain law explains, whose
    form is never exact; but real joints leave more than one further term would account for. Where the evidence does not
    tell, a term stays open that gains more than the form of the plain law may. Which of two such terms fits better says
    as little: what neither law knows of a joint decides that.
    """
    hypotheses = view.equations.library.hypotheses
    others = tuple(k for k in own if k != index)
    likeliest: dict[str, tuple[int, ...]] = {}
    for k in view.equations.library.local[view.joint]:
        law = hypotheses[k].law
        if hypotheses[index].effect in law.contains and compatible(view, others, k):
            likeliest[law.name] = max(likeliest.get(law.name, (*others, k)), (*others, k), key=view.score)
    return {name for name, wider in likeliest.items() if _is_open(view, wider, own, others)}


def _is_open(view: JointView, wider: tuple[int, ...], own: tuple[int, ...], others: tuple[int, ...]) -> bool:
    """Whether a wider law in the place of the plain one could be the cause."""
    if not np.isfinite(view.score(wider)):
        return False
    if _form_matters(view, wider, own, others):
        return True
    preferred = (view.score(wider) - view.score(own)) / np.log(10.0) >= view.limits.tie_odds
    return preferred and _accounts_for_what_is_left(view, wider, own)


def _form_matters(view: JointView, wider: tuple[int, ...], own: tuple[int, ...], others: tuple[int, ...]) -> bool:
    """E(own) − E(wider) ≥ c · explained, not told by the odds: more than the form of the plain law may leave."""
    told = _local_odds(view, own, wider) >= view.limits.tie_odds
    error = view.error(own)
    explained = min(view.error(others) - error, view.torque_power)
    return not told and error - view.error(wider) >= view.limits.least_over_special_case * explained


def _accounts_for_what_is_left(view: JointView, wider: tuple[int, ...], own: tuple[int, ...]) -> bool:
    """E(wider) − E_noise ≤ (E(own) − E_noise) / 2 where E(own) is above the noise."""
    left, after = (view.error(s) - view.noise_power for s in (own, wider))
    return left > 0.0 and after <= REST * left


def replacements(
    view: JointView, own: tuple[int, ...], index: int
) -> Iterator[tuple[tuple[str, ...], tuple[int, ...]]]:
    """Selections with another hypothesis in its place, alone, for it and a neighbour, or two in its place."""
    hypotheses = view.equations.library.hypotheses
    place = hypotheses[index].place
    others = tuple(k for k in own if k != index)
    local = (k for k in view.equations.library.local[view.joint] if hypotheses[k].is_plain)
    fresh = [k for k in local if k not in own and hypotheses[k].place != place]
    own_name = hypotheses[index].effect
    for k in fresh:
        wider = own_name in hypotheses[k].law.contains  # fits at least as well by itself: no rival on its own
        if not wider and compatible(view, others, k):
            yield (hypotheses[k].effect,), (*others, k)
        for gone in others:  # one law for two
            kept = tuple(i for i in others if i != gone)
            both = {own_name, hypotheses[gone].effect} <= {*hypotheses[k].law.confused_with}
            if both and compatible(view, kept, k):
                yield (hypotheses[k].effect,), (*kept, k)
    near = [
        k
        for k in fresh
        if hypotheses[k].effect in hypotheses[index].law.confused_with and own_name not in hypotheses[k].law.contains
    ]
    for n, k in enumerate(near):  # two laws for one
        for m in near[n + 1 :]:
            if compatible(view, others, k) and compatible(view, (*others, k), m):
                yield (hypotheses[k].effect, hypotheses[m].effect), (*others, k, m)


def _arm_wide_comparison(equations: NormalEquations, found: Selection, index: int) -> Comparison:
    hypotheses = equations.library.hypotheses
    others = tuple(i for i in found.arm_wide if i != index)
    best: dict[str, tuple[float, int]] = {}
    for k in equations.library.reaching:
        if k in found.arm_wide or hypotheses[k].place == hypotheses[index].place:
            continue
        score = total_score(equations, (*others, k), found)
        if np.isfinite(score):
            name = hypotheses[k].effect
            best[name] = max(best.get(name, (-np.inf, k)), (score, k))
    odds = {name: _arm_wide_odds(equations, found, (*others, k)) for name, (_, k) in best.items()}
    same = hypotheses[index].effect
    tied = tuple(sorted(n for n, o in odds.items() if o < equations.limits.tie_odds and n != same))
    return Comparison(index, _ranked({n: o for n, o in odds.items() if n != same}), tied)


def _arm_wide_odds(equations: NormalEquations, found: Selection, others: tuple[int, ...]) -> float:
    """log10 odds of the selection over one with other arm-wide hypotheses beside the same local ones."""
    chosen = (*others, *(i for own in found.local for i in own))
    own, other = (float(equations.penalties[list(s)].sum()) for s in (found.indices, chosen))
    return odds_over(equations, found, found.indices, chosen, other - own)


def _ranked(odds: dict[str, float]) -> tuple[tuple[str, float], ...]:
    return tuple(sorted(odds.items(), key=lambda item: item[1])[:SHOWN])
