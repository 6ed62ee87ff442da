"""What a motion, recorded, is expected to add to a diagnosis: ties broken, and effects shown that were not."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.candidate_motions import CandidateMotion
from lagnet.diagnosis.equal_in_motion import equal_in_motion
from lagnet.diagnosis.fitting import Workbench
from lagnet.diagnosis.library import Abstention, Library
from lagnet.diagnosis.open_ties import OpenTie, open_ties
from lagnet.diagnosis.problem import Piece, Problem, pose_problem
from lagnet.diagnosis.rivals import Contest
from lagnet.diagnosis.separation import SURE, Separation, separation
from lagnet.effects.catalogue import effect_named
from lagnet.effects.motion import Motion
from lagnet.models.corrected import CorrectedModel, NamedEffect
from lagnet.recordings.conditioning import Conditioned, Stretch
from lagnet.types import Trajectory

FITTED = 0.8  # of the motion: a diagnosis holds the last fifth of a recording out
OF_BANDWIDTH = 5.0  # samples per period of the bandwidth at which a motion is judged
LEAST_RATE = 100.0  # [Hz] unless the recordings are slower: strokes turn sharply


@dataclass(frozen=True, eq=False)
class Standing:
    """What a diagnosis stands on, as far as the next recording is planned from it.

    Args:
        problem, fit: the recordings.
        library, found, contests: the hypotheses, those selected, and their rivals.
        effects: the selected ones, refitted.
    """

    problem: Problem
    fit: Conditioned
    library: Library
    found: Found
    contests: tuple[Contest, ...]
    effects: tuple[NamedEffect, ...]

    @property
    def corrected(self) -> CorrectedModel:
        """The nominal model with the named effects."""
        problem = self.problem
        return CorrectedModel(problem.nominal, self.effects, problem.slow, problem.held, straight=problem.straight)


@dataclass(frozen=True)
class Expectation:
    """What a recording of one motion is expected to say.

    Args:
        separations: one for each tie, in order.
        shown: for each abstention, whether the motion shows the effect.
    """

    separations: tuple[Separation, ...]
    shown: tuple[bool, ...]

    @property
    def lack(self) -> float:
        """What stays open, to be made small: mostly that of the least separated tie, without being stuck at one."""
        margins = [s.margin for s in self.separations] + [2.0 * SURE * flag for flag in self.shown]
        return float(np.sum(np.exp(-np.sqrt(np.maximum(margins, 0.0)))))


class Prospect:
    """The open questions of a diagnosis, of which any motion can be asked what it would answer.

    Args:
        standing: of the diagnosis.

    Attributes:
        ties: those that motion can break.
        unbreakable: those of laws that are the same while the joint moves.
        abstentions: effects that the recordings could not show.
    """

    def __init__(self, standing: Standing):
        self._standing = standing
        self._bench: Workbench
        self._bench, self._found, ties = open_ties(
            standing.problem, standing.library, standing.found, standing.contests
        )
        self.ties: tuple[OpenTie, ...] = tuple(t for t in ties if not equal_in_motion(t.instead_of, t.rivals))
        self.unbreakable: tuple[OpenTie, ...] = tuple(t for t in ties if equal_in_motion(t.instead_of, t.rivals))
        self._summary = standing.problem.summary()
        self.abstentions: tuple[Abstention, ...] = tuple(filter(self._about_motion, standing.library.abstentions))
        self.rate = min(standing.fit.rate, max(OF_BANDWIDTH * standing.fit.bandwidth, LEAST_RATE))

    def _about_motion(self, abstention: Abstention) -> bool:
        """Whether the reason is the motion, not the model; the last link has another name."""
        law, joint = effect_named(abstention.effect), abstention.joint
        elsewhere = (abstention.effect, joint) == ("link_inertia", self._standing.problem.n_dof - 1)
        return not elsewhere and law.excitation(self._summary, joint) == abstention.reason

    def torque(self, motion: CandidateMotion) -> Trajectory:
        """Torque that the corrected model expects along the motion, shape (n, dof) [N m]."""
        return self._standing.corrected.torque_along(motion.time, motion.q, motion.v, motion.a)

    def expectation(self, motion: CandidateMotion, torque: Trajectory) -> Expectation:
        """What recording the motion is expected to say.

        Args:
            motion: on the clock of `rate`.
            torque: shape (n, dof), expected along it [N m].
        """
        posed = self._posed(motion, torque)
        pieces = [self._tables(posed, piece) for piece in posed.fit]
        joined = [np.concatenate(tables) for tables in zip(*pieces, strict=True)]
        told = tuple(separation(self._bench, self._found, tie, joined) for tie in self.ties)
        both = self._joined_summary(posed)
        shown = tuple(effect_named(a.effect).excitation(both, a.joint) is None for a in self.abstentions)
        return Expectation(told, shown)

    def _posed(self, motion: CandidateMotion, torque: Trajectory) -> Problem:
        n = int(FITTED * motion.time.size)
        stretch = Stretch(motion.time[:n], motion.q[:n], motion.v[:n], motion.a[:n], torque[:n], 0, 0, n - 1)
        conditioned = replace(self._standing.fit, stretches=(stretch,), rate=self.rate)
        posed = pose_problem(self._standing.problem.nominal, conditioned, conditioned)
        told = self._standing.problem
        return replace(posed, slow=told.slow, straight=told.straight, known=told.known)

    def _tables(self, posed: Problem, piece: Piece) -> list[np.ndarray]:
        tables = self._bench.library.tables(posed, piece)
        return [table * piece.counts[:, [joint]] for joint, table in enumerate(tables)]

    def _joined_summary(self, posed: Problem) -> Motion:
        old, new = self._summary, posed.summary()
        time, q, v, a, load = (
            np.concatenate([getattr(old, name), getattr(new, name)]) for name in ("time", "q", "v", "a", "load")
        )
        return Motion(time, q, v, a, load, old.slow, old.model, straight=old.straight)
