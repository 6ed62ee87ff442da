"""The main job: recordings and a nominal model in, a verdict and a corrected model out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from lagnet.diagnosis.adequacy import withdraw
from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.compose import compose_verdict
from lagnet.diagnosis.curves import collect_evidence
from lagnet.diagnosis.drift import Drift, find_drifts
from lagnet.diagnosis.echoes import drop_echoes
from lagnet.diagnosis.equal_in_motion import tie_equals
from lagnet.diagnosis.evidence import Evidence
from lagnet.diagnosis.evidence_of import HeldOut, held_out_evidence
from lagnet.diagnosis.fitting import Workbench, make_workbench
from lagnet.diagnosis.form_error import with_form_error
from lagnet.diagnosis.grams import collect_grams
from lagnet.diagnosis.informed_search import search
from lagnet.diagnosis.leftover import JointLeftover, Leftover, joint_leftovers, left_over, missed_by
from lagnet.diagnosis.library import Library
from lagnet.diagnosis.narrower import best_band
from lagnet.diagnosis.next_recording import Standing
from lagnet.diagnosis.noise_floor import noise_floor
from lagnet.diagnosis.one_clock import on_one_clock
from lagnet.diagnosis.passing import Passing, settle_passing
from lagnet.diagnosis.problem import Problem, pose_problem
from lagnet.diagnosis.prune import refit_and_prune
from lagnet.diagnosis.refit import Refit
from lagnet.diagnosis.rest import friction_at_rest
from lagnet.diagnosis.rivals import Contest, hold_contests
from lagnet.diagnosis.settle import settle_on
from lagnet.diagnosis.sharpness import sharpen
from lagnet.diagnosis.spells import Spell, set_aside
from lagnet.diagnosis.too_vague import TooVague, all_without, too_vague
from lagnet.diagnosis.unjudged import contests_with_unjudged
from lagnet.diagnosis.unsure import drop_unsure
from lagnet.diagnosis.verdict import EffectFound, Verdict
from lagnet.errors import DiagnosisError
from lagnet.models.corrected import CorrectedModel, NamedEffect
from lagnet.recordings.conditioning import Conditioned, condition
from lagnet.recordings.recording import Recording
from lagnet.recordings.splits import holdout_split
from lagnet.types import InverseDynamics


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """What `diagnose` gives back.

    Args:
        verdict: the conclusions.
        corrected: the nominal model with the named physics.
        evidence: the curves behind the verdict, for reports.
        fit_recordings, holdout_recordings: what was used for what.
        conditioned_holdout: the held-out recordings on their even clock.
        ends_of: for each held-out recording the index of the fitted one that it is the end of, None for another.
        standing: what the next recording is planned from.
    """

    verdict: Verdict
    corrected: CorrectedModel
    evidence: Evidence
    fit_recordings: tuple[Recording, ...]
    holdout_recordings: tuple[Recording, ...]
    conditioned_holdout: Conditioned
    ends_of: tuple[int | None, ...]
    standing: Standing

    @property
    def effects(self) -> tuple[EffectFound, ...]:
        """The physics that was left out, strongest first."""
        return self.verdict.effects

    def to_json(self) -> str:
        """The text of verdict.json."""
        return self.verdict.to_json()


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


def diagnose(
    recordings: Sequence[Recording],
    robot: InverseDynamics | Any,
    holdout: Sequence[Recording] | None = None,
    *,
    bandwidth: float | None = None,
    nominal_error: np.ndarray | None = None,
    seed: int = 0,
) -> Diagnosis:
    """Says whether and where recordings differ from a model, names the physics left out, and corrects the model.

    Args:
        recordings: of the real arm (or of the better simulation), joints as the robot's.
        robot: the nominal model: a Robot, a learned model, or the corrected model of an earlier diagnosis.
        holdout: recordings that are not fitted; None: the last fifth of each recording.
        bandwidth: of the zero-phase low-pass on torques [Hz]; None: chosen from the data, and narrower where that
            explains much more.
        nominal_error: shape (dof,), torque that the nominal model is known to miss, such as a learned one [N m]; it
            counts into the noise floor. None: what an earlier diagnosis left, if the model comes from one.
        seed: of everything random.

    Raises:
        DiagnosisError: no recording, or joints that are not the model's.
    """
    fit_on, held = _divide(recordings, robot, holdout)
    ends_of = (None,) * len(held) if holdout else tuple(range(len(held)))
    known = nominal_error if nominal_error is not None else getattr(robot, "left", None)

    def at(band: float | None, shift: float = 0.0) -> Inquiry:
        fit = condition(fit_on, band, shift)
        unseen = condition(held, fit.bandwidth, shift)
        problem = replace(sharpen(pose_problem(robot, fit, unseen, ends_of)), missed=known)
        noise = noise_floor(problem, fit, seed)
        noise = noise if known is None else np.hypot(noise, known)
        inquiry = inquire(problem, fit, unseen, noise, seed)
        return settle_passing(inquiry, lambda part: inquire(part, fit, unseen, noise, seed))

    first = at(bandwidth) if bandwidth is not None else best_band(at(None), at)
    inquiry = with_form_error(on_one_clock(first, lambda shift: at(first.fit.bandwidth, shift)))
    seen = inquiry.problem
    corrected = CorrectedModel(robot, inquiry.effects, seen.slow, seen.held, left=missed_by(inquiry))
    verdict, evidence = compose_verdict(inquiry, fit_on, held), collect_evidence(inquiry, fit_on, held)
    return Diagnosis(verdict, corrected, evidence, fit_on, held, inquiry.holdout, ends_of, inquiry.standing)


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


def _divide(
    recordings: Sequence[Recording], robot: InverseDynamics, holdout: Sequence[Recording] | None
) -> tuple[tuple[Recording, ...], tuple[Recording, ...]]:
    if not recordings:
        raise DiagnosisError(
            "no recording was given", next_step="give at least one recording of joint motion and torque"
        )
    for recording in (*recordings, *(holdout or ())):
        if recording.n_dof != robot.n_dof:
            raise DiagnosisError(
                f"the recording has {recording.n_dof} joints, the model {robot.n_dof}",
                where=recording.path or None,
                choices=robot.joints,
            )
    if holdout:
        return tuple(recordings), tuple(holdout)
    return holdout_split(recordings)
