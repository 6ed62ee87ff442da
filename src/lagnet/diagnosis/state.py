"""The results of all steps of one diagnosis, as a value: the verdict, the report and the files are made from it."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from lagnet.diagnosis.estimation.refit import Refit
from lagnet.diagnosis.identifiability.ambiguity import AmbiguousCause
from lagnet.diagnosis.identifiability.rivals import Comparison
from lagnet.diagnosis.identified.fit import Identified
from lagnet.diagnosis.identified.known_layers import KnownLayers
from lagnet.diagnosis.problem.intervals import EventInterval, lasting, set_aside
from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.regression.cross_validation import NormalEquations
from lagnet.diagnosis.regression.library import Library
from lagnet.diagnosis.rules.rule import Rejection
from lagnet.diagnosis.selection.arm_search import Selection
from lagnet.diagnosis.selection.holdout_gain import HoldoutGain
from lagnet.diagnosis.transients.transient import Transient
from lagnet.diagnosis.unexplained.friction_drift import Drift, find_drifts
from lagnet.diagnosis.unexplained.remainder import (
    JointRemainder,
    Remainder,
    RemainderSize,
    joint_remainders,
    remainder_of,
    remainder_sizes,
)
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.recordings.conditioning.condition import Conditioned


@dataclass(frozen=True, eq=False)
class DiagnosisState:
    """The results of one run of the pipeline.

    Args:
        problem: recordings and nominal model as compared.
        fit, holdout: the recordings on an even clock.
        noise: shape (dof,), noise floor [N m].
        library: the hypotheses.
        equations, holdout_equations: normal equations of the fitted and of the held-out recordings.
        selection: the selected hypotheses.
        comparisons: each of them against its rivals.
        holdout_gain: what each does for held-out recordings.
        refit: the persistent effects with parameters and intervals.
        seed: of everything random.
        rejected: effects that were considered and not named.
        transients: effects that act for a while only.
        events: intervals in which something without a name acts.
        ambiguous: causes that too many names explain equally.
        supposed: the persistent effects with the likeliest name of every ambiguous cause; empty: those of `refit`.
        judged: the problem with free links beside which the names were judged; None: `problem`.
        layers: identified layers, computed once; shared by all runs on the same recordings.
    """

    problem: Problem
    fit: Conditioned
    holdout: Conditioned
    noise: np.ndarray
    library: Library
    equations: NormalEquations
    holdout_equations: NormalEquations
    selection: Selection
    comparisons: tuple[Comparison, ...]
    holdout_gain: dict[int, HoldoutGain]
    refit: Refit
    seed: int
    rejected: tuple[Rejection, ...] = ()
    transients: tuple[Transient, ...] = ()
    events: tuple[EventInterval, ...] = ()
    ambiguous: tuple[AmbiguousCause, ...] = ()
    supposed: tuple[NamedEffect, ...] = ()
    judged: Problem | None = None
    layers: KnownLayers = field(default_factory=KnownLayers)

    @property
    def effects(self) -> tuple[NamedEffect, ...]:
        """Persistent effects and transients."""
        return (*self.refit.effects, *(p.effect for p in self.transients))

    @property
    def sigma(self) -> np.ndarray:
        """Residual of the persistent effects at each joint, at least the noise, shape (dof,) [N m]."""
        return self.selection.sigma(self.equations)

    @property
    def origins(self) -> dict[int, int | None]:
        """By held-out recording, the fitted one that it is the end of or whose load it carries; None for another."""
        return {p.recording: p.origin for p in self.problem.holdout}

    @property
    def lasting_effects(self) -> tuple[NamedEffect, ...]:
        """What lasts: beside it events are looked for. A cause is there, whatever its name."""
        return self.supposed or self.refit.effects

    @cached_property
    def drifts(self) -> tuple[Drift, ...]:
        """Friction that changes over a recording."""
        return find_drifts(set_aside(self.problem, self.events), self.effects)

    @cached_property
    def after(self) -> Remainder:
        """Residuals of the corrected model, its links as free as the names were judged."""
        return remainder_of(self.judged or self.problem, self.effects)

    @cached_property
    def sizes(self) -> tuple[RemainderSize, ...]:
        """How much remains at each joint."""
        return remainder_sizes(self.problem, self.after, self.noise)

    @cached_property
    def sizes_beside_supposed(self) -> tuple[RemainderSize, ...]:
        """How much remains at each joint beside the likeliest name of every ambiguous cause: what puzzles."""
        if not self.supposed:
            return self.sizes
        effects = (*self.lasting_effects, *(p.effect for p in self.transients))
        return remainder_sizes(self.problem, remainder_of(self.judged or self.problem, effects), self.noise)

    @cached_property
    def remainders(self) -> tuple[JointRemainder, ...]:
        """The remainder of each joint: power, residual share and predictable share."""
        return joint_remainders(self.problem, self.after, self.sizes, self.noise, self.seed)

    @property
    def identified(self) -> Identified | None:
        """What the fitted recordings determine beside the named effects, whatever its cause; None where nothing."""
        return self.layers.beside(lasting(self.problem, self.events), self.effects)

    @property
    def identified_alone(self) -> Identified | None:
        """What the fitted recordings determine in the place of all names; None where nothing."""
        return self.layers.beside(self.problem, ())

    @property
    def sensor_noise(self) -> np.ndarray:
        """Noise floor without the error that the nominal model is known to make, shape (dof,) [N m]."""
        known = 0.0 if self.problem.missed is None else self.problem.missed
        return np.sqrt(np.maximum(self.noise**2 - np.square(known), 0.0))

    @property
    def corrected(self) -> CorrectedModel:
        """The nominal model with the named effects."""
        problem = self.problem
        return CorrectedModel(problem.nominal, self.effects, problem.slow, problem.held, problem.straight)
