"""argmax over motions of the expected log odds between tied names, and of the excitation of unexcited effects."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.diagnose import Diagnosis
from lagnet.diagnosis.regression.library import Abstention
from lagnet.errors import DiagnosisError
from lagnet.experiment_design.expected_information import Expectation, Prospect
from lagnet.experiment_design.motion_family import (
    SHRINKING,
    CandidateMotion,
    change_decision_vector,
    draw_decision_vector,
    motion_of,
)
from lagnet.experiment_design.motion_limits import MotionLimits, motion_limits
from lagnet.experiment_design.open_ties import OpenTie
from lagnet.recordings.recording import Recording


@dataclass(frozen=True)
class SearchSettings:
    """Size of the random search.

    Args:
        draws: motions drawn at random.
        kept: of the best of them, improved by a random walk.
        steps: of each walk.
        most_seconds: of processor time, after which the best so far is returned. Reached only with very fast sampling
            or many joints; then the motion depends on the machine.
    """

    draws: int = 80
    kept: int = 2
    steps: int = 120
    most_seconds: float = 120.0


@dataclass(frozen=True, eq=False)
class SuggestedMotion:
    """A motion to record next with its expected information.

    Args:
        recording: time, q, v, a, and as `tau` the torque that the corrected model expects: a forecast, no measurement.
        limits: that the motion keeps.
        ties: that motion can break, in the order of `expectation`.
        unbreakable: ties that no motion breaks.
        abstentions: effects that the recordings did not excite.
        expectation: expected information on ties and abstentions.
        seed: of the search.
    """

    recording: Recording
    limits: MotionLimits
    ties: tuple[OpenTie, ...]
    unbreakable: tuple[OpenTie, ...]
    abstentions: tuple[Abstention, ...]
    expectation: Expectation
    seed: int

    @property
    def is_of_use(self) -> bool:
        """Whether the recording is expected to break a tie or to excite an effect."""
        return any(s.breaks for s in self.expectation.separations) or any(self.expectation.shown)


def suggest_motion(
    diagnosis: Diagnosis, seed: int = 0, settings: SearchSettings | None = None
) -> SuggestedMotion | None:
    """argmin over motions within the arm's limits of the questions that stay open; None if none is open.

    Motions are drawn at random; the best are improved by a random walk. Collisions of the
    arm with itself or its surroundings are not checked.

    Args:
        diagnosis: with ties or abstentions.
        seed: of the search; the same seed gives the same motion.
        settings: how long to search.
    """
    prospect = Prospect(diagnosis.state)
    if not prospect.ties and not prospect.abstentions and not prospect.unbreakable:
        return None
    limits = motion_limits(diagnosis.state.problem)
    search = _Search(prospect, limits, settings or SearchSettings(), np.random.default_rng(seed))
    best = search.best()
    rate, joints = diagnosis.state.fit.rate, diagnosis.state.problem.joints
    motion, torque = search.within_limits(best.decision_vector, rate)
    recording = Recording(motion.time, motion.q, torque, joints, v=motion.v, a=motion.a)
    expected = best.expectation
    return SuggestedMotion(recording, limits, prospect.ties, prospect.unbreakable, prospect.abstentions, expected, seed)


@dataclass(frozen=True, eq=False)
class _Candidate:
    decision_vector: np.ndarray
    expectation: Expectation


class _Search:
    """Random draws, then a random walk from the best of them that accepts improvements."""

    def __init__(self, prospect: Prospect, limits: MotionLimits, settings: SearchSettings, rng: np.random.Generator):
        self._prospect, self._limits, self._settings, self._rng = prospect, limits, settings, rng
        self._end = time.process_time() + settings.most_seconds

    def best(self) -> _Candidate:
        """argmin of `Expectation.lack`."""
        n_dof = self._limits.middle.size
        drawn = [self._evaluated(draw_decision_vector(n_dof, self._rng))]
        while len(drawn) < self._settings.draws and not self._late():
            drawn.append(self._evaluated(draw_decision_vector(n_dof, self._rng)))
        starts = sorted(drawn, key=lambda c: c.expectation.lack)[: self._settings.kept]
        return min((self._walk(c) for c in starts), key=lambda c: c.expectation.lack)

    def within_limits(self, decision_vector: np.ndarray, rate: float) -> tuple[CandidateMotion, np.ndarray]:
        """q(t; x), scaled down until its torque is within limits, and that torque, shape (n, dof).

        Raises:
            DiagnosisError: even hardly moving takes more torque than the arm has.
        """
        for shrink in SHRINKING:
            motion = motion_of(decision_vector, self._limits, rate, shrink)
            torque = self._prospect.torque(motion)
            if self._limits.allow(motion.q, motion.v, motion.a, torque):
                return motion, torque
        raise DiagnosisError(
            "no motion was found whose torque stays inside the arm's limits",
            next_step="hold the effort limits of the robot description against the recorded torque",
        )

    def _late(self) -> bool:
        return time.process_time() > self._end

    def _walk(self, candidate: _Candidate) -> _Candidate:
        for _ in range(self._settings.steps):
            if self._late():
                break
            other = self._evaluated(change_decision_vector(candidate.decision_vector, self._rng))
            if other.expectation.lack < candidate.expectation.lack:
                candidate = other
        return candidate

    def _evaluated(self, decision_vector: np.ndarray) -> _Candidate:
        motion, torque = self.within_limits(decision_vector, self._prospect.rate)
        return _Candidate(decision_vector, self._prospect.expectation(motion, torque))
