"""The main job: recordings and a nominal model in, a verdict and a corrected model out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lagnet.diagnosis.compose import compose_verdict
from lagnet.diagnosis.conventions import refuse_other_conventions
from lagnet.diagnosis.curves import collect_evidence
from lagnet.diagnosis.evidence import Evidence
from lagnet.diagnosis.form_error import with_form_error
from lagnet.diagnosis.inquiry import Inquiry, inquire
from lagnet.diagnosis.leftover import missed_by
from lagnet.diagnosis.narrower import best_band
from lagnet.diagnosis.next_recording import Standing
from lagnet.diagnosis.noise_floor import noise_floor
from lagnet.diagnosis.one_clock import on_one_clock
from lagnet.diagnosis.open_axes import settle_open_axes
from lagnet.diagnosis.passing import settle_passing
from lagnet.diagnosis.problem import pose_problem
from lagnet.diagnosis.sharpness import sharpen
from lagnet.diagnosis.verdict import EffectFound, Verdict
from lagnet.errors import DiagnosisError
from lagnet.models.corrected import CorrectedModel
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
        DiagnosisError: no recording, joints that are not the model's, or recordings in another convention (signs,
            units, zeros of joints) than the model.
    """
    fit_on, held = _divide(recordings, robot, holdout)
    ends_of = (None,) * len(held) if holdout else tuple(range(len(held)))
    known = nominal_error if nominal_error is not None else getattr(robot, "left", None)
    robot = settle_open_axes(robot, fit_on, held, known, seed)

    def at(band: float | None, shift: float = 0.0) -> Inquiry:
        fit = condition(fit_on, band, shift)
        unseen = condition(held, fit.bandwidth, shift)
        posed = pose_problem(robot, fit, unseen, ends_of)
        refuse_other_conventions(posed)
        problem = replace(sharpen(posed), missed=known)
        noise = noise_floor(problem, fit, seed)
        noise = noise if known is None else np.hypot(noise, known)
        inquiry = inquire(problem, fit, unseen, noise, seed)
        return settle_passing(inquiry, lambda part: inquire(part, fit, unseen, noise, seed))

    first = at(bandwidth) if bandwidth is not None else best_band(at(None), at)
    inquiry = with_form_error(on_one_clock(first, lambda shift: at(first.fit.bandwidth, shift)))
    seen = inquiry.problem
    told = (seen.slow, seen.held, seen.straight)
    corrected = CorrectedModel(robot, inquiry.effects, *told, left=missed_by(inquiry))
    verdict, evidence = compose_verdict(inquiry, fit_on, held), collect_evidence(inquiry, fit_on, held)
    return Diagnosis(verdict, corrected, evidence, fit_on, held, inquiry.holdout, ends_of, inquiry.standing)


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
