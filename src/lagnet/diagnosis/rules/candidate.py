"""A selection of effects with everything that a rule may ask of it, each quantity computed once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

import numpy as np

from lagnet.diagnosis.estimation.left_out import LeftOut
from lagnet.diagnosis.estimation.refit import Refit, refit
from lagnet.diagnosis.identified.borne_out import powers_beside
from lagnet.diagnosis.identified.fit import Identified
from lagnet.diagnosis.identified.known_layers import KnownLayers
from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.diagnosis.problem.residuals import left_by
from lagnet.diagnosis.regression.cross_validation import NormalEquations
from lagnet.diagnosis.regression.library import Library
from lagnet.diagnosis.selection.arm_search import Selection, refit_selection
from lagnet.diagnosis.selection.holdout_gain import HoldoutGain, holdout_gains
from lagnet.diagnosis.selection.named_effects import named_effects
from lagnet.diagnosis.settings import DecisionLimits
from lagnet.models.corrected.named_effects import NamedEffect

Part = Literal["fit", "holdout"]


@dataclass(frozen=True, eq=False)
class Candidate:
    """A selection of hypotheses on the recordings of one diagnosis.

    Args:
        problem: recordings and nominal model.
        equations, holdout_equations: normal equations of the fitted and of the held-out recordings.
        selection: the hypotheses, with the coefficients of the linear fit.
        noise: shape (dof,), noise floor [N m].
        seed: of everything random.
        start: effects of the refit before, from which the next one starts.
        residuals: r by part and effects, computed once; shared by all candidates of one diagnosis.
        layers: identified layers, computed once; shared by all runs on the same recordings.
        left: what the one without names leaves, computed once; shared by all candidates.
    """

    problem: Problem
    equations: NormalEquations
    holdout_equations: NormalEquations
    selection: Selection
    noise: np.ndarray
    seed: int
    start: tuple[NamedEffect, ...] = ()
    residuals: dict = field(default_factory=dict, repr=False)
    layers: KnownLayers = field(default_factory=KnownLayers)
    left: dict = field(default_factory=dict, repr=False)

    @property
    def limits(self) -> DecisionLimits:
        """Where the diagnosis decides."""
        return self.problem.limits

    @property
    def library(self) -> Library:
        """All hypotheses."""
        return self.equations.library

    @property
    def indices(self) -> tuple[int, ...]:
        """Numbers of the selected hypotheses in the library, in the order of `effects`."""
        return self.selection.indices

    @cached_property
    def sigma(self) -> np.ndarray:
        """σ_j: root mean square residual of the linear fit at each joint, at least the noise, shape (dof,) [N m]."""
        return self.selection.sigma(self.equations)

    @cached_property
    def refit(self) -> Refit:
        """The selection fitted by the exact laws, all parameters together."""
        known = {(e.effect, e.joint): e for e in self.start}
        found = named_effects(self.library, self.selection)
        return refit(self.problem, [known.get((e.effect, e.joint), e) for e in found], self.sigma, choices_stay=False)

    @property
    def effects(self) -> tuple[NamedEffect, ...]:
        """The selected effects with the parameters of the refit."""
        return self.refit.effects

    @cached_property
    def left_out(self) -> LeftOut:
        """The refit, each effect of which may be left out."""
        return LeftOut(self.problem, self.effects, self.sigma)

    @cached_property
    def holdout_gain(self) -> dict[int, HoldoutGain]:
        """Held-out nMSE without and with each selected hypothesis, the others refitted."""
        return holdout_gains(self.equations, self.holdout_equations, self.selection, self.problem.scale, self.sigma)

    @property
    def identified(self) -> Identified | None:
        """What the fitted recordings determine where no effect is named; None where that predicts nothing."""
        return self.layers.beside(self.problem, ())

    @property
    def left_by_layer(self) -> np.ndarray:
        """Share of each joint's held-out mismatch beyond the noise that the layer leaves, shape (dof,); 1 for none."""
        if self.identified is None:
            return np.ones(self.problem.n_dof)
        if "share" not in self.left:
            before, after = powers_beside(self.problem, self.segments("holdout"), (), self.identified.layer)
            power = self.noise**2
            self.left["share"] = np.maximum(after - power, 0.0) / np.maximum(before - power, 1e-300)
        return self.left["share"]

    def segments(self, part: Part) -> tuple[Segment, ...]:
        """The fitted or the held-out segments."""
        return self.problem.fit if part == "fit" else self.problem.holdout

    def residual(self, part: Part, effects: Sequence[NamedEffect] | None = None) -> np.ndarray:
        """r = F(τ − τ_nominal − Σ τ_effect), zero where a sample is not valid, shape (n, dof) [N m].

        Args:
            effects: None: the selected ones, refitted.
        """
        chosen = self.effects if effects is None else tuple(effects)
        key = part, tuple(e.key for e in chosen)
        if key not in self.residuals:
            self.residuals[key] = left_by(self.problem, self.segments(part), chosen)
        return self.residuals[key]

    def power(self, part: Part, effects: Sequence[NamedEffect] | None = None) -> np.ndarray:
        """Mean square residual of each joint over its valid samples, shape (dof,) [N² m²]; effects as in `residual`."""
        valid = np.concatenate([p.counts for p in self.segments(part)])
        return np.sum(self.residual(part, effects) ** 2, axis=0) / np.maximum(1, valid.sum(axis=0))

    def torque(self, part: Part, effect: NamedEffect) -> np.ndarray:
        """F τ_effect of one effect alone, zero where a sample is not valid, shape (n, dof) [N m]."""
        return self.residual(part, ()) - self.residual(part, (effect,))

    def torques_at(self, part: Part, effect: NamedEffect, joint: int) -> np.ndarray:
        """F τ at a joint of an effect, in the first column, and of each other one, shape (n, effects) [N m]."""
        others = (e for e in self.effects if e != effect)
        return np.column_stack([self.torque(part, e)[:, joint] for e in (effect, *others)])

    def without(self, *indices: int, instead: Sequence[int] = ()) -> Candidate:
        """The candidate without some hypotheses, with others in the place of the first, fitted again.

        Another form of a link that is changed already takes the place of the form it has.
        """
        found, first, library = self.selection, {*indices[:1]}, self.library
        links = {library.hypotheses[k].place: k for k in instead if k in library.reaching}
        here = tuple(k for k in instead if k not in library.reaching)
        arm_wide = tuple(links.get(library.hypotheses[i].place, i) for i in found.arm_wide if i not in indices)
        local = tuple((*(i for i in own if i not in indices), *(here if first & {*own} else ())) for own in found.local)
        start = self.refit.effects if "refit" in self.__dict__ else self.start
        selection = refit_selection(self.equations, replace(found, arm_wide=arm_wide, local=local))
        return replace(self, selection=selection, start=start)
