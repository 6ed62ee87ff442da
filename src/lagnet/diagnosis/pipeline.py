"""The steps of a diagnosis in their order, on a problem already posed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from lagnet.diagnosis.estimation.friction_at_rest import friction_at_rest
from lagnet.diagnosis.estimation.intervals.misspecification import interval_errors, widened, with_convention
from lagnet.diagnosis.estimation.intervals.unselected_laws import shifts_beside_unselected, short_of_absence
from lagnet.diagnosis.estimation.refit import Refit
from lagnet.diagnosis.estimation.special_case import with_special_cases
from lagnet.diagnosis.exchanged_bodies import with_links_alike, with_real_bodies
from lagnet.diagnosis.exchanged_gains import without_wide_gains
from lagnet.diagnosis.free_bodies import (
    are_scaled_widely,
    beside_free_bodies,
    bodies_are_refuted,
    take_the_place_of_gains,
)
from lagnet.diagnosis.identifiability.ambiguity import AmbiguousCause, ambiguous_causes
from lagnet.diagnosis.identifiability.equivalent_laws import tie_equivalent_laws
from lagnet.diagnosis.identifiability.first_joint_zero import tie_tilt_and_first_zero
from lagnet.diagnosis.identifiability.rivals import Comparison, compare_with_rivals
from lagnet.diagnosis.identifiability.unexcited_rivals import with_unexcited_rivals
from lagnet.diagnosis.identified.known_layers import KnownLayers
from lagnet.diagnosis.problem.intervals import lasting
from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.regression.block_gram import collect_block_grams
from lagnet.diagnosis.regression.cross_validation import sum_normal_equations
from lagnet.diagnosis.rules.apply import Eliminated, apply_rules
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.rule import RejectionRule
from lagnet.diagnosis.selection.iterated_search import search
from lagnet.diagnosis.state import DiagnosisState
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.recordings.conditioning.condition import Conditioned


@dataclass(frozen=True, eq=False)
class Inputs:
    """The inputs of a run of the pipeline beside the problem.

    Args:
        fit, holdout: the recordings on an even clock.
        noise: shape (dof,), noise floor [N m].
        rules: that every named effect must pass.
        seed: of everything random.
        layers: identified layers of all runs on these recordings.
    """

    fit: Conditioned
    holdout: Conditioned
    noise: np.ndarray
    rules: Sequence[RejectionRule]
    seed: int
    layers: KnownLayers = field(default_factory=KnownLayers)


@dataclass(frozen=True, eq=False)
class Judged:
    """What all rules leave.

    Args:
        left: the candidate, and all rejections.
        comparisons: of each of its effects with its rivals.
        ambiguous: causes that too many names explain equally, which are no longer among the effects.
        supposed: the effects as they were fitted with these; empty where there are none.
    """

    left: Eliminated
    comparisons: tuple[Comparison, ...]
    ambiguous: tuple[AmbiguousCause, ...] = ()
    supposed: tuple[NamedEffect, ...] = ()


def run_pipeline(problem: Problem, given: Inputs) -> DiagnosisState:
    """Search, elimination, comparison with rivals, and what is held out, in this order."""
    first = _searched(problem, given)
    left = apply_rules([r for r in given.rules if not r.after_refit], first)
    if left.candidate.problem.given is None:
        left = replace(left, candidate=without_wide_gains(with_real_bodies(left.candidate)))
        beside = _beside_free_links(left.candidate, given)
        if beside is not None:
            return beside
    left = _further(left, [r for r in given.rules if r.after_refit])
    return _concluded(_judged(left, given), given)


def _searched(problem: Problem, given: Inputs) -> Candidate:
    """The best selection of hypotheses, as the rules see it."""
    problem, equations, found = search(problem, given.noise)
    unseen = sum_normal_equations(
        equations.library, collect_block_grams(problem, equations.library, problem.holdout), problem.limits
    )
    return Candidate(problem, equations, unseen, found, given.noise, given.seed, layers=given.layers)


def _further(left: Eliminated, rules: Sequence[RejectionRule], *gone: int) -> Eliminated:
    """What further rules leave of a candidate, without some hypotheses; all rejections are kept."""
    again = apply_rules(rules, left.candidate.without(*gone) if gone else left.candidate)
    return replace(again, rejected=(*left.rejected, *again.rejected))


def _judged(left: Eliminated, given: Inputs) -> Judged:
    """The candidate without ambiguous causes, and how what remains compares with its rivals."""
    candidate, comparisons = left.candidate, _comparisons(left.candidate)
    ambiguous = ambiguous_causes(candidate.library, comparisons, candidate.limits.most_names)
    if not ambiguous:
        return Judged(left, comparisons)
    again = _further(left, [r for r in given.rules if r.after_each_fit], *ambiguous)
    return Judged(again, _comparisons(again.candidate), tuple(ambiguous.values()), candidate.refit.effects)


def _concluded(found: Judged, given: Inputs) -> DiagnosisState:
    """The state of what remains: special cases where these do, and friction at rest."""
    candidate = found.left.candidate
    fitted = with_special_cases(candidate.problem, candidate.refit, candidate.sigma)
    return DiagnosisState(
        replace(candidate.problem, held=friction_at_rest(candidate.problem, fitted.effects)),
        given.fit,
        given.holdout,
        given.noise,
        candidate.library,
        candidate.equations,
        candidate.holdout_equations,
        candidate.selection,
        found.comparisons,
        candidate.holdout_gain,
        fitted,
        given.seed,
        found.left.rejected,
        ambiguous=found.ambiguous,
        supposed=found.supposed,
        layers=given.layers,
    )


def _beside_free_links(candidate: Candidate, given: Inputs) -> DiagnosisState | None:
    """The results beside inertial parameters of all links; None where those of few links do as well."""
    refuted = bodies_are_refuted(candidate)
    if not refuted and not are_scaled_widely(candidate):
        return None
    free = beside_free_bodies(candidate.problem, given.noise, candidate.identified)
    if free is None:
        return None
    beside = run_pipeline(free, given)
    return beside if refuted or take_the_place_of_gains(beside, candidate) else None


def _comparisons(candidate: Candidate) -> tuple[Comparison, ...]:
    comparisons = compare_with_rivals(candidate.equations, candidate.selection)
    comparisons = with_unexcited_rivals(candidate.problem, candidate.library, candidate.selection, comparisons)
    comparisons = tie_equivalent_laws(candidate.library, comparisons, candidate.effects)
    comparisons = tie_tilt_and_first_zero(candidate.problem, candidate.library, comparisons, candidate.effects)
    return with_links_alike(candidate, comparisons)


def with_misspecification(state: DiagnosisState) -> DiagnosisState:
    """The same with 95 % intervals √(h_L² + δp² + t² Δp²); names and values stay.

    h_L is of long blocks, δp the misspecification error, Δp the shift beside laws that were not selected.
    """
    effects = state.effects
    if not effects:
        return state
    problem, sigma = lasting(state.problem, state.events), state.sigma
    errors = [with_convention(*pair) for pair in zip(effects, interval_errors(problem, effects, sigma), strict=True)]
    old = (*state.refit.intervals, *(p.intervals for p in state.transients))
    wide = [widened(*pair) for pair in zip(old, errors, strict=True)]
    shifts = shifts_beside_unselected(problem, effects, sigma)
    wide = [short_of_absence(*one) for one in zip(effects, wide, shifts, strict=True)]
    n = len(state.refit.effects)
    refit = Refit(state.refit.effects, tuple(wide[:n]), state.refit.correlations)
    transients = tuple(replace(p, intervals=w) for p, w in zip(state.transients, wide[n:], strict=True))
    return replace(state, refit=refit, transients=transients)
