"""Expected information of a motion: log odds of ties, and excitation of effects that were not excited."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.identifiability.equivalent_laws import observationally_equivalent
from lagnet.diagnosis.problem.problem import Problem, Segment, pose_problem
from lagnet.diagnosis.regression.cross_validation import NormalEquations
from lagnet.diagnosis.regression.library import Abstention
from lagnet.diagnosis.state import DiagnosisState
from lagnet.effects.catalogue import effect_named
from lagnet.effects.motion import Motion
from lagnet.experiment_design.discrimination import SURE, Separation, separation
from lagnet.experiment_design.motion_family import CandidateMotion
from lagnet.experiment_design.open_ties import OpenTie, open_ties
from lagnet.recordings.conditioning.condition import Stretch
from lagnet.types import Trajectory

FITTED = 0.8  # of the motion: a diagnosis holds the last fifth of a recording out
OF_BANDWIDTH = 5.0  # samples per period of the bandwidth at which a motion is evaluated
LEAST_RATE = 100.0  # [Hz] unless the recordings are slower: strokes reverse quickly


@dataclass(frozen=True)
class Expectation:
    """Expected information of one motion.

    Args:
        separations: one for each tie, in order.
        shown: for each abstention, whether the motion excites the effect.
    """

    separations: tuple[Separation, ...]
    shown: tuple[bool, ...]

    @property
    def lack(self) -> float:
        """Σ exp(−√margin), to be minimised: a smooth count of questions that stay open, the least separated most."""
        margins = [s.margin for s in self.separations] + [2.0 * SURE * flag for flag in self.shown]
        return float(np.sum(np.exp(-np.sqrt(np.maximum(margins, 0.0)))))


class Prospect:
    """The open questions of a diagnosis, and the expected information of any motion on them.

    Args:
        state: of the diagnosis.

    Attributes:
        ties: those that motion can break.
        unbreakable: those of observationally equivalent laws.
        abstentions: effects that the recordings did not excite.
    """

    def __init__(self, state: DiagnosisState):
        self._state = state
        self._equations: NormalEquations
        self._equations, self._found, ties = open_ties(state.problem, state.library, state.selection, state.comparisons)
        self.ties: tuple[OpenTie, ...] = tuple(
            t for t in ties if not observationally_equivalent(t.instead_of, t.rivals)
        )
        self.unbreakable: tuple[OpenTie, ...] = tuple(
            t for t in ties if observationally_equivalent(t.instead_of, t.rivals)
        )
        self._summary = state.problem.summary()
        self.abstentions: tuple[Abstention, ...] = tuple(filter(self._about_motion, state.library.abstentions))
        self.rate = min(state.fit.rate, max(OF_BANDWIDTH * state.fit.bandwidth, LEAST_RATE))

    def _about_motion(self, abstention: Abstention) -> bool:
        """Whether the motion is the reason, and not the model; a change of the last link is a payload."""
        law, joint = effect_named(abstention.effect), abstention.joint
        elsewhere = (abstention.effect, joint) == ("link_inertia", self._state.problem.n_dof - 1)
        return not elsewhere and law.excitation(self._summary, joint) == abstention.reason

    def torque(self, motion: CandidateMotion) -> Trajectory:
        """Torque of the corrected model along the motion, shape (n, dof) [N m]."""
        return self._state.corrected.torque_along(motion.time, motion.q, motion.v, motion.a)

    def expectation(self, motion: CandidateMotion, torque: Trajectory) -> Expectation:
        """The expected information of a motion.

        Args:
            motion: on the clock of `rate`.
            torque: shape (n, dof), expected along it [N m].
        """
        posed = self._posed(motion, torque)
        pieces = [self._tables(posed, piece) for piece in posed.fit]
        joined = [np.concatenate(tables) for tables in zip(*pieces, strict=True)]
        separations = tuple(separation(self._equations, self._found, tie, joined) for tie in self.ties)
        both = self._joined_summary(posed)
        shown = tuple(effect_named(a.effect).excitation(both, a.joint) is None for a in self.abstentions)
        return Expectation(separations, shown)

    def _posed(self, motion: CandidateMotion, torque: Trajectory) -> Problem:
        n = int(FITTED * motion.time.size)
        stretch = Stretch(motion.time[:n], motion.q[:n], motion.v[:n], motion.a[:n], torque[:n], 0, 0, n - 1)
        conditioned = replace(self._state.fit, stretches=(stretch,), rate=self.rate)
        posed = pose_problem(self._state.problem.nominal, conditioned, conditioned)
        present = self._state.problem
        return replace(posed, slow=present.slow, straight=present.straight, known=present.known)

    def _tables(self, posed: Problem, piece: Segment) -> list[np.ndarray]:
        tables = self._equations.library.tables(posed, piece)
        return [table * piece.counts[:, [joint]] for joint, table in enumerate(tables)]

    def _joined_summary(self, posed: Problem) -> Motion:
        old, new = self._summary, posed.summary()
        time, q, v, a, load = (
            np.concatenate([getattr(old, name), getattr(new, name)]) for name in ("time", "q", "v", "a", "load")
        )
        return Motion(time, q, v, a, load, old.slow, old.model, straight=old.straight)
