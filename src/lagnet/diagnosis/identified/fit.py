"""Estimates the identified layer: all that recordings determine beside the named physics, without naming its cause."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.identified.consistent import consistent_unknowns
from lagnet.diagnosis.identified.design import BODY, Design, Seen, make_design, usual_rest
from lagnet.diagnosis.identified.dictionary import term_groups
from lagnet.diagnosis.identified.evidence import fit_ridge, sums_of
from lagnet.diagnosis.identified.folds import Choice, choose
from lagnet.diagnosis.identified.rest import friction_at_rest
from lagnet.diagnosis.problem.problem import Problem, Segment, spread_evenly
from lagnet.models.corrected.changed_bodies import inertial_parameters_of, named_body_change
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.motion_terms import INERTIA, Rest
from lagnet.models.corrected.named_effects import NamedEffect, load_before, torque_with

NOTHING = 1e-7  # of a joint's torque: a term of that size was left out
HARMFUL = 1.2  # times the squared error of a joint without the layer, all samples counted
NEGLIGIBLE = 0.01  # of the standard deviation of a joint's torque
POSES = 50  # at which the mass matrix is looked at
INDEFINITE = 1e-9  # least eigenvalue of a mass matrix, in parts of the largest torque: rounding
MOST_SAMPLES = 120_000  # at full rate: of longer recordings, pieces spread over them


@dataclass(frozen=True, eq=False)
class Identified:
    """The layer with what it was estimated from.

    Args:
        layer: changes of bodies and functions of motion.
        design: the equations; unknowns are the layer's parameters divided by their scales.
        choice: their solution, and what it was chosen by.
    """

    layer: IdentifiedLayer
    design: Design
    choice: Choice


def identify(problem: Problem, effects: Sequence[NamedEffect]) -> Identified | None:
    """Everything that the fitted recordings determine beside named effects, drawn to nothing where they do not.

    None where it would predict no joint's torque on unseen blocks better than the named physics alone.

    Args:
        problem: the diagnosis' problem.
        effects: named physics that stays as it is.
    """
    groups, rest = term_groups(problem), usual_rest(problem)
    seen = [_seen(problem, p, effects) for p in spread_evenly(problem.fit, MOST_SAMPLES)]
    first = make_design(problem, seen, [g for g in groups if not g.needs_load and g.pair is None])
    ridge = fit_ridge(first, sums_of(first), temper=10.0, steps=15)
    seen = [_under(s, _layer(first, ridge.x, rest)) for s in seen]
    for pieces in (seen, [replace(s, regressor=None) for s in seen]):  # without bodies where these harm some joint
        design = make_design(problem, pieces, groups)
        choice = choose(design)
        if choice is not None:
            layer, found, choice = _possible(problem, effects, design, choice, rest)
            layer = replace(layer, rest=friction_at_rest(problem, pieces, layer))
            if not _harms(problem, pieces, layer):
                return Identified(layer, found, choice)
    return None


def _harms(problem: Problem, seen: Sequence[Seen], layer: IdentifiedLayer) -> bool:
    """Whether some joint's fitted torque, samples at rest included, is predicted clearly worse with the layer."""
    before, after = np.zeros((2, problem.n_dof))
    for s in seen:
        motion = s.piece.motion(problem)
        bodies = 0.0 if s.regressor is None or layer.bodies is None else s.regressor @ layer.bodies.ravel()
        added = layer.term_torque(motion, s.load) + bodies
        before += np.sum(problem.reduce(s.piece, s.target) ** 2, axis=0)
        after += np.sum(problem.reduce(s.piece, s.target - added) ** 2, axis=0)
    count = sum(s.piece.keep.size for s in seen)
    return bool(np.any(after > HARMFUL * before + NEGLIGIBLE**2 * count * problem.scale**2))


def _possible(
    problem: Problem, effects: Sequence[NamedEffect], design: Design, choice: Choice, rest: Rest
) -> tuple[IdentifiedLayer, Design, Choice]:
    """The layer, less the rotors and ties that would make the mass matrix indefinite somewhere on the motion."""
    model = CorrectedModel(problem.nominal, tuple(effects), problem.slow, straight=problem.straight)
    q = np.concatenate([p.q[p.keep] for p in problem.fit])
    q = q[np.unique(np.linspace(0, len(q) - 1, POSES).round().astype(int))]
    while True:
        x = choice.ridge.x
        layer = _layer(design, x, rest)
        if design.n_bodies:
            x, bodies = consistent_unknowns(design, sums_of(design), choice, _modelled(problem, effects))
            layer = replace(_layer(design, x, rest), bodies=bodies)
        before, after = (m.mass_matrix(q) for m in (model, replace(model, identified=layer)))
        worst = int(np.argmin(np.linalg.eigvalsh(after)[:, 0]))
        least, direction = (part[..., 0] for part in np.linalg.eigh(after[worst]))
        floor = min(float(np.linalg.eigvalsh(before)[:, 0].min()), 0.0) - INDEFINITE * float(problem.scale.max())
        wrong = _impossible(design, design.unscaled(x), direction)
        if least >= floor or wrong is None:
            return layer, design, choice
        design = design.without(np.array([wrong]))
        choice = replace(choice, ridge=fit_ridge(design, sums_of(design), choice.temper, barred=choice.barred))


def _impossible(design: Design, x: np.ndarray, direction: np.ndarray) -> int | None:
    """The rotor or tie that takes most inertia away from a direction of joint speeds; None where none does."""
    taken = np.zeros(len(design.terms))
    for i, term in enumerate(design.terms):
        if term.kind in INERTIA:
            share = (
                direction[term.joint] ** 2 if term.other is None else 2 * direction[term.joint] * direction[term.other]
            )
            taken[i] = share * x[design.n_bodies + i]
    worst = int(np.argmin(taken))
    return design.n_bodies + worst if taken[worst] < 0 else None


def _modelled(problem: Problem, effects: Sequence[NamedEffect]) -> np.ndarray:
    """Ten parameters of each link with named changes, shape (dof, 10)."""
    return inertial_parameters_of(problem.nominal) + named_body_change(problem.n_dof, effects)


def _seen(problem: Problem, piece: Segment, effects: Sequence[NamedEffect]) -> Seen:
    """A piece with its regressor, under gravity as named, and what the named model leaves of its torque."""
    motion = replace(piece.motion(problem), recorded=None)  # a prediction sees no recorded torque
    model = CorrectedModel(problem.nominal, tuple(effects), problem.slow, straight=problem.straight)
    source = model.regressor_source
    regressor = None if source is None else source.joint_torque_regressor(piece.q, piece.v, piece.a)
    named = torque_with(motion, effects)
    return Seen(piece, regressor, load_before(motion, effects, "torque"), piece.tau - named)


def _under(seen: Seen, layer: IdentifiedLayer) -> Seen:
    """The same piece with the torque of the bodies as far as they are known by now."""
    if seen.regressor is None or layer.bodies is None:
        return seen
    return Seen(seen.piece, seen.regressor, seen.load + seen.regressor @ layer.bodies.ravel(), seen.target)


def _layer(design: Design, unknowns: np.ndarray, rest: Rest) -> IdentifiedLayer:
    x = design.unscaled(unknowns)
    bodies = x[: design.n_bodies].reshape(-1, BODY) if design.n_bodies else None
    weights = x[design.n_bodies :]
    used = np.flatnonzero(np.abs(unknowns[design.n_bodies :]) > NOTHING)
    return IdentifiedLayer(bodies, tuple(design.terms[i] for i in used), weights[used], rest)
