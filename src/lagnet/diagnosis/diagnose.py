"""The main job: recordings and a nominal model in, a verdict and a corrected model out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from lagnet.diagnosis.data_quality.inspect import refused_with, screened_for
from lagnet.diagnosis.free_bodies import against_given
from lagnet.diagnosis.holdout_torque import HoldoutTorque
from lagnet.diagnosis.layers import correct
from lagnet.diagnosis.nominal.axis_offsets import settle_axis_offsets
from lagnet.diagnosis.nominal.conventions import refuse_other_conventions
from lagnet.diagnosis.pipeline import Inputs, run_pipeline, with_misspecification
from lagnet.diagnosis.problem.dry_friction import fit_sign_model
from lagnet.diagnosis.problem.noise_floor import noise_floor
from lagnet.diagnosis.problem.problem import Problem, pose_problem
from lagnet.diagnosis.reruns.band import best_band
from lagnet.diagnosis.reruns.clock import on_one_clock
from lagnet.diagnosis.reruns.links import beside_links
from lagnet.diagnosis.reruns.transients import settle_transients
from lagnet.diagnosis.rules.catalogue import RULES
from lagnet.diagnosis.rules.rule import RejectionRule
from lagnet.diagnosis.settings import DecisionLimits
from lagnet.diagnosis.state import DiagnosisState
from lagnet.diagnosis.verdict.collect_report_data import collect_report_data
from lagnet.diagnosis.verdict.compose import compose_verdict
from lagnet.diagnosis.verdict.layers import with_layers
from lagnet.diagnosis.verdict.report_data import ReportData
from lagnet.diagnosis.verdict.verdict import EffectFound, Verdict, with_data_quality
from lagnet.errors import DiagnosisError
from lagnet.models.corrected.model import CorrectedModel
from lagnet.recordings.conditioning.condition import Conditioned, condition
from lagnet.recordings.recording import Recording
from lagnet.recordings.splits import holdout_split
from lagnet.types import InverseDynamics

MOST_JOINTS = 64  # a hundred take more than two gigabytes and minutes; humanoids have about thirty


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """What `diagnose` gives back.

    Args:
        verdict: the conclusions.
        corrected: the nominal model with all layers of the correction.
        evidence: the curves behind the verdict, for reports.
        fit_recordings, holdout_recordings: what was used for what.
        conditioned_holdout: the held-out recordings on their even clock.
        ends_of: for each held-out recording the index of the fitted one that it is the end of, or whose load it
            carries; None for another.
        state: all that its steps found out.
        holdout_torques: torque of each layer at every held-out sample.
    """

    verdict: Verdict
    corrected: CorrectedModel
    evidence: ReportData
    fit_recordings: tuple[Recording, ...]
    holdout_recordings: tuple[Recording, ...]
    conditioned_holdout: Conditioned
    ends_of: tuple[int | None, ...]
    state: DiagnosisState
    holdout_torques: tuple[HoldoutTorque, ...]

    @property
    def effects(self) -> tuple[EffectFound, ...]:
        """The physics that was left out, strongest first."""
        return self.verdict.effects

    def to_json(self) -> str:
        """The text of verdict.json."""
        return self.verdict.to_json()


@threadpool_limits.wrap(limits=1)  # matrices are small: threads of the linear algebra would only wait for each other
def diagnose(
    recordings: Sequence[Recording],
    robot: InverseDynamics | Any,
    holdout: Sequence[Recording] | None = None,
    *,
    bandwidth: float | None = None,
    nominal_error: np.ndarray | None = None,
    rules: Sequence[RejectionRule] = RULES,
    limits: DecisionLimits | None = None,
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
        rules: that every named effect must pass; an ablation is `RULES` less one.
        limits: shared by several steps; None: the defaults.
        seed: of everything random.

    Raises:
        DiagnosisError: no recording, joints that are not the model's, more than 64 joints, or recordings in another
            convention (signs, units, zeros of joints) than the model.
        RecordingError: data that would be named as physics: dead or stuck channels, another clock or order of joints.
    """
    _check(recordings, robot, holdout)
    data = screened_for((*recordings, *(holdout or ())), robot)
    read, apart = data.recordings[: len(recordings)], data.recordings[len(recordings) :]
    fit_on, held = (read, apart) if holdout else holdout_split(read)
    ends_of = (None,) * len(held) if holdout else tuple(range(len(held)))
    known = nominal_error if nominal_error is not None else getattr(robot, "left", None)
    robot = settle_axis_offsets(robot, fit_on, held, known, seed)

    def at(band: float | None, shift: float = 0.0) -> DiagnosisState:
        fit = condition(fit_on, band, shift)
        unseen = condition(held, fit.bandwidth, shift)
        posed = pose_problem(robot, fit, unseen, ends_of, limits)
        with refused_with(data.findings):
            refuse_other_conventions(posed)
        problem = replace(fit_sign_model(posed), missed=known)
        noise = noise_floor(problem, fit, seed)
        noise = noise if known is None else np.hypot(noise, known)
        given = Inputs(fit, unseen, noise, rules, seed)

        def run(part: Problem) -> DiagnosisState:
            return run_pipeline(part, given)

        return beside_links(settle_transients(run(problem), run), run)

    first = at(bandwidth) if bandwidth is not None else best_band(at(None), at)
    state = with_misspecification(on_one_clock(first, lambda shift: at(first.fit.bandwidth, shift)))
    state = against_given(state)
    ends_of = tuple(state.origins.get(n) for n in range(len(held)))
    correction = correct(state, held, ends_of)
    evidence = collect_report_data(state, fit_on, held, correction.model)
    verdict = compose_verdict(state, fit_on, held)
    verdict = with_layers(verdict, correction.errors, correction.identified, correction.model)
    verdict = with_data_quality(verdict, data.findings)
    conditioned = state.holdout
    return Diagnosis(verdict, correction.model, evidence, fit_on, held, conditioned, ends_of, state, correction.torques)


def _check(recordings: Sequence[Recording], robot: InverseDynamics, holdout: Sequence[Recording] | None) -> None:
    if not recordings:
        raise DiagnosisError(
            "no recording was given", next_step="give at least one recording of joint motion and torque"
        )
    if robot.n_dof > MOST_JOINTS:
        raise DiagnosisError(
            f"the model has {robot.n_dof} joints; {MOST_JOINTS} at most are diagnosed together",
            next_step="give a model of the part that moved, and recordings of its joints",
        )
    for recording in (*recordings, *(holdout or ())):
        if recording.n_dof != robot.n_dof:
            raise DiagnosisError(
                f"the recording has {recording.n_dof} joints, the model {robot.n_dof}",
                where=recording.path or None,
                choices=robot.joints,
            )
