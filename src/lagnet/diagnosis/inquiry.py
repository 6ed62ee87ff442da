"""The steps of one diagnosis in their order, and all that they found out."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from lagnet.diagnosis.adequacy import withdraw
from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.drift import Drift, find_drifts
from lagnet.diagnosis.echoes import drop_echoes
from lagnet.diagnosis.equal_in_motion import tie_equals
from lagnet.diagnosis.evidence_of import HeldOut, held_out_evidence
from lagnet.diagnosis.fitting import Workbench, make_workbench
from lagnet.diagnosis.grams import collect_grams
from lagnet.diagnosis.informed_search import search
from lagnet.diagnosis.leftover import JointLeftover, Leftover, joint_leftovers, left_over
from lagnet.diagnosis.library import Library
from lagnet.diagnosis.next_recording import Standing
from lagnet.diagnosis.passing import Passing
from lagnet.diagnosis.problem import Problem
from lagnet.diagnosis.prune import refit_and_prune
from lagnet.diagnosis.refit import Refit
from lagnet.diagnosis.rest import friction_at_rest
from lagnet.diagnosis.rivals import Contest, hold_contests
from lagnet.diagnosis.settle import settle_on
from lagnet.diagnosis.spells import Spell, set_aside
from lagnet.diagnosis.strangers import drop_likenesses
from lagnet.diagnosis.too_dense import drop_too_dense
from lagnet.diagnosis.too_vague import TooVague, all_without, too_vague
from lagnet.diagnosis.turning_delays import drop_turning_delays
from lagnet.diagnosis.unjudged import contests_with_unjudged
from lagnet.diagnosis.unsure import drop_unsure
from lagnet.models.corrected import NamedEffect
from lagnet.recordings.conditioning import Conditioned


@dataclass(frozen=True, eq=False)
class Inquiry:
    """All that the steps of one diagnosis found out, for those who put it into words and pictures.

    `refit` holds what lasts; `passing` what acts for a while only; `spells` the intervals that have no name,
    `vague` the causes that have too many.
    """

    problem: Problem
    fit: Conditioned
    holdout: Conditioned
    noise: np.ndarray
    library: Library
    bench: Workbench
    unseen: Workbench
    found: Found
    contests: tuple[Contest, ...]
    held_out: dict[int, HeldOut]
    refit: Refit
    seed: int
    passing: tuple[Passing, ...] = ()
    spells: tuple[Spell, ...] = ()
    vague: tuple[TooVague, ...] = ()

    @property
    def effects(self) -> tuple[NamedEffect, ...]:
        """What lasts and what passes."""
        return (*self.refit.effects, *(p.effect for p in self.passing))

    @cached_property
    def drifts(self) -> tuple[Drift, ...]:
        """Friction that changes over a recording."""
        return find_drifts(set_aside(self.problem, self.spells), self.effects)

    @cached_property
    def after(self) -> Leftover:
        """Residuals of the corrected model."""
        return left_over(self)

    @cached_property
    def leftovers(self) -> tuple[JointLeftover, ...]:
        """What is left at each joint."""
        return joint_leftovers(self, self.after)

    @property
    def standing(self) -> Standing:
        """What the next recording is planned from."""
        return Standing(self.problem, self.fit, self.library, self.found, self.contests, self.refit.effects)


def inquire(problem: Problem, fit: Conditioned, unseen: Conditioned, noise: np.ndarray, seed: int) -> Inquiry:
    """The steps of a diagnosis in their order, on a problem already posed."""
    problem, bench, found = search(problem, noise)
    library = bench.library
    judge = make_workbench(library, collect_grams(problem, library, problem.holdout))
    found = settle_on(bench, judge, found, problem.scale)
    found, fitted = drop_echoes(problem, bench, *refit_and_prune(problem, bench, found))
    found, fitted = _sifted(problem, bench, judge, found, fitted, noise, seed)
    contests = _contests(problem, bench, found, fitted)
    vague = too_vague(library, contests)
    if vague:
        found, fitted = refit_and_prune(problem, bench, all_without(bench, found, [*vague]))
        contests = _contests(problem, bench, found, fitted)
    sigma = found.sigma(bench)
    problem = replace(problem, held=friction_at_rest(problem, fitted.effects))
    parts = held_out_evidence(bench, judge, found, problem.scale, sigma)
    told = tuple(vague.values())
    return Inquiry(problem, fit, unseen, noise, library, bench, judge, found, contests, parts, fitted, seed, vague=told)


def _sifted(
    problem: Problem, bench: Workbench, judge: Workbench, found: Found, fitted: Refit, noise: np.ndarray, seed: int
) -> tuple[Found, Refit]:
    """The selection less the names that fail, until none does: without one, others may."""
    while True:
        modest = withdraw(problem, bench, judge, found, fitted.effects, noise, seed)
        if modest is found:
            modest = drop_likenesses(problem, bench, found, fitted.effects, noise)
        if modest is found:
            modest = drop_too_dense(problem, bench, found, fitted.effects)
        if modest is found:
            modest = drop_turning_delays(problem, bench, found, fitted.effects)
        if modest is not found:
            found, fitted = refit_and_prune(problem, bench, modest)
            continue
        sure, refitted = drop_unsure(problem, bench, found, fitted)
        if sure is found:
            return found, fitted
        found, fitted = sure, refitted


def _contests(problem: Problem, bench: Workbench, found: Found, fitted: Refit) -> tuple[Contest, ...]:
    contests = contests_with_unjudged(problem, bench.library, found, hold_contests(bench, found))
    return tie_equals(bench.library, contests, fitted.effects)
