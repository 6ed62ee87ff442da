"""Rotors, links and ties of the identified layer that an arm can have: a mass matrix that is positive definite at every
pose, and no rotor with less than no inertia where its link can have the difference."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.identified.consistent import consistent_unknowns, squared_errors
from lagnet.diagnosis.identified.design import Design
from lagnet.diagnosis.identified.equations import joint_equations
from lagnet.diagnosis.identified.evidence import fit_ridge
from lagnet.diagnosis.identified.folds import Choice
from lagnet.diagnosis.problem.problem import Problem
from lagnet.models.corrected.changed_bodies import named_body_change
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.modelled import modelled_weight
from lagnet.models.corrected.motion_terms import INERTIA, MotionTerm, Rest
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.recordings.sampling import spread_rows
from lagnet.rigid_body.inertia import BODY
from lagnet.types import inertial_parameters_of

NOTHING = 1e-7  # of a joint's torque: a smaller term is zero
POSES = 50  # at which the mass matrix is tested
INDEFINITE = 1e-9  # −(least eigenvalue of a mass matrix) over the largest torque: rounding
SAME = 1.02  # of squared errors without a negative rotor and with it, up to which the links have its inertia


def positive_definite(
    problem: Problem, effects: Sequence[NamedEffect], design: Design, choice: Choice, rest: Rest
) -> tuple[IdentifiedLayer, Design, Choice, int | None]:
    """The layer without couplings that would make the mass matrix indefinite at some pose of the motion.

    Where a rotor does, its joint comes back as well, and the layer is not settled.
    """
    model = CorrectedModel(problem.nominal, tuple(effects), problem.slow, straight=problem.straight)
    q = np.concatenate([p.q[p.keep] for p in problem.fit])
    q = q[spread_rows(len(q), POSES)]
    while True:
        x = choice.ridge.x
        layer = layer_of(design, x, rest)
        if design.n_bodies:
            x, bodies = consistent_unknowns(design, joint_equations(design), choice, _modelled_links(problem, effects))
            layer = replace(layer_of(design, x, rest), bodies=bodies)
        before, after = (m.mass_matrix(q) for m in (model, replace(model, identified=layer)))
        worst = int(np.argmin(np.linalg.eigvalsh(after)[:, 0]))
        least, direction = (part[..., 0] for part in np.linalg.eigh(after[worst]))
        floor = min(float(np.linalg.eigvalsh(before)[:, 0].min()), 0.0) - INDEFINITE * float(problem.scale.max())
        negative = _most_negative(design, design.unscaled(x), direction)
        if least >= floor or negative is None:
            return layer, design, choice, None
        term = design.terms[negative - design.n_bodies]
        if term.kind == "rotor":
            return layer, design, choice, term.joint
        design = design.without(np.array([negative]))
        choice = replace(
            choice, ridge=fit_ridge(design, joint_equations(design), choice.inefficiency, excluded=choice.excluded)
        )


def _most_negative(design: Design, x: np.ndarray, direction: np.ndarray) -> int | None:
    """argmin over rotors and couplings of their share of vᵀM v in a direction v; None where none is negative."""
    inertia = np.zeros(len(design.terms))
    for i, term in enumerate(design.terms):
        if term.kind in INERTIA:
            share = (
                direction[term.joint] ** 2 if term.other is None else 2 * direction[term.joint] * direction[term.other]
            )
            inertia[i] = share * x[design.n_bodies + i]
    worst = int(np.argmin(inertia))
    return design.n_bodies + worst if inertia[worst] < 0 else None


def _modelled_links(problem: Problem, effects: Sequence[NamedEffect]) -> np.ndarray:
    """Ten parameters of each link with named changes, shape (dof, 10)."""
    return inertial_parameters_of(problem.nominal) + named_body_change(problem.n_dof, effects)


def without_negative_rotors(
    problem: Problem, effects: Sequence[NamedEffect], layer: IdentifiedLayer, design: Design, choice: Choice
) -> tuple[IdentifiedLayer, Design, Choice]:
    """The layer without rotors that the arm would have less than nothing of, where links explain their torque as well.

    The inertia of a first link about its axis and that of its rotor are one number: what is drawn towards a model with
    other links would leave the difference to the rotor.
    """
    negative = rotors_of(design, _negative_rotors(problem, effects, layer))
    return given_to_links(problem, effects, layer, design, choice, negative)


def given_to_links(
    problem: Problem,
    effects: Sequence[NamedEffect],
    layer: IdentifiedLayer,
    design: Design,
    choice: Choice,
    unknowns: np.ndarray,
) -> tuple[IdentifiedLayer, Design, Choice]:
    """The layer without some functions of motion; the given one where any joint's squared error grows by over 2 %."""
    if not unknowns.size or not design.n_bodies:
        return layer, design, choice
    fewer = design.without(unknowns)
    sums = joint_equations(fewer)
    ridge = fit_ridge(fewer, sums, choice.inefficiency, excluded=choice.excluded)
    other, fewer, fitted, rotor = positive_definite(problem, effects, fewer, replace(choice, ridge=ridge), layer.rest)
    before = squared_errors(design, joint_equations(design), _scaled(design, layer))
    after = squared_errors(fewer, sums, _scaled(fewer, other))
    return (other, fewer, fitted) if rotor is None and np.all(after <= SAME * before) else (layer, design, choice)


def _scaled(design: Design, layer: IdentifiedLayer) -> np.ndarray:
    """The unknowns of the equations that make a layer, shape (n_unknowns,)."""
    weights = dict(zip(layer.terms, layer.weights, strict=True))
    bodies = np.zeros(0) if layer.bodies is None else layer.bodies.ravel()
    return np.concatenate([bodies, [weights.get(t, 0.0) for t in design.terms]]) * design.scale


def _negative_rotors(problem: Problem, effects: Sequence[NamedEffect], layer: IdentifiedLayer) -> set[int]:
    """Joints whose rotor, modelled, named and identified together, has less than no inertia."""
    total = np.array([modelled_weight(problem.nominal, "rotor_inertia", j) for j in range(problem.n_dof)])
    for e in effects:
        if e.effect == "rotor_inertia" and e.joint is not None:
            total[e.joint] += e.values["Ia"]
    pairs = zip(layer.terms, layer.weights, strict=True)
    return {t.joint for t, weight in pairs if t.kind == "rotor" and weight < -total[t.joint]}


def columns_of(design: Design, kind: str) -> list[tuple[int, MotionTerm]]:
    """Index of each unknown that weights a function of some kind, and the function."""
    return [(design.n_bodies + i, t) for i, t in enumerate(design.terms) if t.kind == kind]


def rotors_of(design: Design, joints: Collection[int]) -> np.ndarray:
    """Indices of the unknowns that are rotors of some joints."""
    return np.array([i for i, t in columns_of(design, "rotor") if t.joint in joints], dtype=int)


def layer_of(design: Design, unknowns: np.ndarray, rest: Rest) -> IdentifiedLayer:
    """The layer that scaled unknowns make, shape (n_unknowns,)."""
    x = design.unscaled(unknowns)
    bodies = x[: design.n_bodies].reshape(-1, BODY) if design.n_bodies else None
    weights = x[design.n_bodies :]
    used = np.flatnonzero(np.abs(unknowns[design.n_bodies :]) > NOTHING)
    return IdentifiedLayer(bodies, tuple(design.terms[i] for i in used), weights[used], rest)
