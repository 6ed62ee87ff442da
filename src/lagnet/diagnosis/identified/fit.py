"""Y Δπ + Σ_i w_i φ_i(q, v, a): estimates the identified layer, all that recordings determine beside named physics."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.identified.design import Design, FitSegment, make_design, usual_rest
from lagnet.diagnosis.identified.dictionary import GAIN, OF_LOAD, TermGroup, lag_groups, term_groups
from lagnet.diagnosis.identified.equations import joint_equations
from lagnet.diagnosis.identified.evidence import fit_ridge
from lagnet.diagnosis.identified.folds import INEFFICIENCIES, Choice, choose
from lagnet.diagnosis.identified.friction.dissipation import driving_friction, with_friction
from lagnet.diagnosis.identified.friction.rest import friction_at_rest
from lagnet.diagnosis.identified.friction.reversals import excessive_bristles, late_bristles
from lagnet.diagnosis.identified.real_inertia import (
    columns_of,
    layer_of,
    positive_definite,
    rotors_of,
    without_negative_rotors,
)
from lagnet.diagnosis.problem.problem import Problem, Segment, spread_evenly
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.motion_terms import MotionTerm, Rest
from lagnet.models.corrected.named_effects import NamedEffect, load_before, torque_with

HARMFUL = 1.2  # times the squared error of a joint without the layer, all samples counted
NEGLIGIBLE = 0.01  # of the standard deviation of a joint's torque
NORMAL_95 = 1.96  # half width of a 95 % interval in standard deviations
ROUNDS, SETTLED = 6, 0.02  # fits at most, and share of r² up to which torque of the load is that of its own bodies
MOST_SAMPLES = 120_000  # at full rate: of longer recordings, pieces spread over them


@dataclass(frozen=True, eq=False)
class Identified:
    """The layer, its equations and their solution.

    Args:
        layer: changes of bodies and functions of motion.
        design: the equations; unknowns are the layer's parameters divided by their scales.
        choice: their solution with its held-out error.
    """

    layer: IdentifiedLayer
    design: Design
    choice: Choice

    def half_width(self, term: MotionTerm) -> float:
        """Half of the 95 % interval of the weight of one of the layer's functions."""
        k = self.design.n_bodies + self.design.terms.index(term)
        scale = self.design.scale[k]
        return float(NORMAL_95 * np.sqrt(max(self.choice.ridge.covariance[k, k], 0.0)) / scale) if scale > 0 else 0.0


def identify(problem: Problem, effects: Sequence[NamedEffect]) -> Identified | None:
    """Changes of bodies and functions of motion that the fitted recordings determine beside named effects.

    None where they predict no joint's torque on held-out blocks better than the named physics alone.

    Args:
        problem: the diagnosis' problem.
        effects: named physics, kept fixed.
    """
    groups, rest = term_groups(problem), usual_rest(problem)
    segments = [fit_segment(problem, p, effects) for p in spread_evenly(problem.fit, MOST_SAMPLES)]
    first = make_design(problem, segments, [g for g in groups if not g.needs_load and not g.optional])
    ridge = fit_ridge(first, joint_equations(first), inefficiency=10.0, steps=15)
    loaded = _with_load(segments, layer_of(first, ridge.x, rest))
    without_bodies = [replace(s, regressor=None) for s in loaded]
    for bare, pieces in ((segments, loaded), (without_bodies, without_bodies)):  # where changed bodies harm some joint
        found = _settled(problem, effects, bare, pieces, groups, rest)
        if found is not None and not _harms(problem, _with_load(bare, found.layer), found.layer):
            return found
    return None


def _settled(
    problem: Problem,
    effects: Sequence[NamedEffect],
    bare: Sequence[FitSegment],
    pieces: Sequence[FitSegment],
    groups: Sequence[TermGroup],
    rest: Rest,
) -> Identified | None:
    """The layer, fitted anew until its friction and scales of recorded torque are those under its own bodies' load.

    Args:
        bare: fitted motion under the load of the named bodies.
        pieces: the same under the load of bodies as first estimated.
    """
    tried = []
    for _ in range(ROUNDS):
        found = _fitted(problem, effects, pieces, groups, rest)
        if found is None:
            break
        own = _with_load(bare, found.layer)
        tried.append((_unsettled(problem, found, pieces, own), found))
        if tried[-1][0] <= SETTLED:
            break
        pieces = own
    return min(tried, key=lambda one: one[0])[1] if tried else None


def _unsettled(problem: Problem, found: Identified, fitted: Sequence[FitSegment], own: Sequence[FitSegment]) -> float:
    """Largest share of a joint's r² by which torque of the load differs between that of the fit and of its bodies."""
    weights = np.where([t.kind in OF_LOAD for t in found.layer.terms], found.layer.weights, 0.0)
    loaded, differs = replace(found.layer, weights=weights), np.zeros(problem.n_dof)
    for before, after in zip(fitted, own, strict=True) if weights.any() else ():
        motion = after.piece.motion(problem)
        change = loaded.term_torque(motion, after.load) - loaded.term_torque(motion, before.load)
        differs += np.sum(problem.reduce(after.piece, change) ** 2 * after.piece.counts, axis=0)
    count = np.maximum(1, sum(s.piece.counts.sum(axis=0) for s in own))
    return float(np.max(differs / count / np.maximum(found.choice.ridge.variance, 1e-300)))


def _fitted(
    problem: Problem,
    effects: Sequence[NamedEffect],
    pieces: Sequence[FitSegment],
    groups: Sequence[TermGroup],
    rest: Rest,
) -> Identified | None:
    """The layer on some equations; a joint whose rotor would be negative has speed that lags in its place."""
    late: set[int] = set()
    while True:
        design = make_design(problem, pieces, [*groups, *lag_groups(problem, late)])
        design, choice = _chosen(problem, effects, pieces, design.without(rotors_of(design, late)))
        if choice is None:
            return None
        negative = {t.joint for i, t in columns_of(design, "rotor") if choice.ridge.x[i] < 0}
        layer, design, choice, rotor = positive_definite(problem, effects, design, choice, rest)
        if rotor is None:
            layer, design, choice = without_negative_rotors(problem, effects, layer, design, choice)
            return Identified(replace(layer, rest=friction_at_rest(problem, pieces, layer)), design, choice)
        late |= {rotor} | negative  # where one is no rotor, no negative one is


def _chosen(
    problem: Problem, effects: Sequence[NamedEffect], pieces: Sequence[FitSegment], design: Design
) -> tuple[Design, Choice | None]:
    """The solution, without friction that no gear has or that is late at reversals; and the equations that it is of."""
    candidates: Sequence[float] = INEFFICIENCIES
    known = with_friction(problem, effects)
    while (choice := choose(design, candidates)) is not None:
        spared = np.concatenate(
            [_impossible(design, choice), excessive_bristles(design, choice), driving_friction(design, choice, known)]
        )
        if not spared.size:
            spared = late_bristles(problem, pieces, design, choice)
        if not spared.size:
            break
        design, candidates = design.without(spared), (choice.inefficiency,)
    return design, choice


def _impossible(design: Design, choice: Choice) -> np.ndarray:
    """Unknowns of friction beyond the load, that of a link that is hardly modelled, and of no or less scale."""
    weights = design.unscaled(choice.ridge.x)
    friction = [i for i, _ in columns_of(design, "load") if abs(weights[i]) > 1.0]
    return np.array(friction + [i for i, _ in columns_of(design, GAIN) if weights[i] <= -1.0], dtype=int)


def _harms(problem: Problem, pieces: Sequence[FitSegment], layer: IdentifiedLayer) -> bool:
    """Whether some joint's fitted torque, samples at rest included, is predicted clearly worse with the layer."""
    before, after = np.zeros((2, problem.n_dof))
    for s in pieces:
        motion = s.piece.motion(problem)
        bodies = 0.0 if s.regressor is None or layer.bodies is None else s.regressor @ layer.bodies.ravel()
        added = layer.term_torque(motion, s.load) + bodies
        before += np.sum(problem.reduce(s.piece, s.target) ** 2, axis=0)
        after += np.sum(problem.reduce(s.piece, s.target - added) ** 2, axis=0)
    count = sum(s.piece.keep.size for s in pieces)
    return bool(np.any(after > HARMFUL * before + NEGLIGIBLE**2 * count * problem.scale**2))


def fit_segment(problem: Problem, piece: Segment, effects: Sequence[NamedEffect]) -> FitSegment:
    """A segment with its regressor, under gravity as named, and the residual of the named model."""
    motion = replace(piece.motion(problem), recorded=None)  # a prediction does not use recorded torque
    model = CorrectedModel(problem.nominal, tuple(effects), problem.slow, straight=problem.straight)
    source = model.regressor_source
    regressor = None if source is None else source.joint_torque_regressor(piece.q, piece.v, piece.a)
    named = torque_with(motion, effects)
    return FitSegment(piece, regressor, load_before(motion, effects, "torque"), piece.tau - named)


def _with_load(segments: Sequence[FitSegment], layer: IdentifiedLayer) -> list[FitSegment]:
    """The same segments, under the load of the named bodies, with the torque of the bodies as estimated so far."""
    bodies = layer.bodies
    if bodies is None:
        return list(segments)
    return [s if s.regressor is None else replace(s, load=s.load + s.regressor @ bodies.ravel()) for s in segments]
