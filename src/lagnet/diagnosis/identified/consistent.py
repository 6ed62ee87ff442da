"""Bodies that masses can have in the place of the ridge's: the same data, drawn to the modelled links by entropy.

With all else refitted around them, the data's cost of a change of bodies is quadratic. To it comes at most one nat for
each unit of log-determinant divergence from the modelled links made rounder, over positive definite pseudo-inertias:
what the recordings leave open stays as modelled. Source: Wensing 2018, Lee 2020.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lagnet.diagnosis.identified.design import BODY, Design
from lagnet.diagnosis.identified.evidence import Sums
from lagnet.diagnosis.identified.folds import Choice
from lagnet.rigid_body.consistent_fit import fit_consistent
from lagnet.rigid_body.inertia import from_pseudo_inertia, parameters_of_body, pseudo_inertia

NATS = (1.0, 0.1, 0.01, 0.001)  # per unit of divergence from the modelled links: the first that fits
LIGHTEST = 0.1  # of the mean mass of the links: a lighter one may be one that the model has no mass for
RADIUS = 0.1  # of the ball that stands for such a link [m]
WORSE = 1.5  # times the squared error of free parameters at a joint: beyond, no bodies are what is missing


def consistent_unknowns(
    design: Design, sums: Sequence[Sums], choice: Choice, modelled: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Unknowns (scaled) whose bodies are physically consistent, or those of the ridge where such fit clearly worse.

    With them the change of the bodies, shape (dof, 10): it has parameters too that the motion does not show.

    Args:
        design: the equations.
        sums: their normal equations.
        choice: the ridge's solution.
        modelled: shape (dof, 10), parameters of the links that are changed.
    """
    limit = WORSE * _errors(design, sums, choice.ridge.x)
    for weight in NATS:
        try:
            x, bodies = _constrained(design, sums, choice, np.asarray(modelled, dtype=float), weight)
        except np.linalg.LinAlgError:
            continue
        if np.all(_errors(design, sums, x) <= limit):
            return x, bodies
    free = choice.ridge.x
    return free, design.unscaled(free)[: design.n_bodies].reshape(-1, BODY)


def _errors(design: Design, sums: Sequence[Sums], x: np.ndarray) -> np.ndarray:
    return np.array([s.error(x[j.unknowns]) for s, j in zip(sums, design.joints, strict=True)])


def _constrained(
    design: Design, sums: Sequence[Sums], choice: Choice, modelled: np.ndarray, weight: float
) -> tuple[np.ndarray, np.ndarray]:
    n, nb, ridge = design.n_unknowns, design.n_bodies, choice.ridge
    gram, moment = np.zeros((n, n)), np.zeros(n)
    for s, joint, power in zip(sums, design.joints, ridge.variance * choice.temper, strict=True):
        gram[np.ix_(joint.unknowns, joint.unknowns)] += s.gram / power
        moment[joint.unknowns] += s.moment / power
    bodies, rest = slice(0, nb), slice(nb, n)
    own = gram[rest, rest] + np.diag(ridge.precision[rest])
    around = np.linalg.solve(own, np.column_stack([gram[rest, bodies], moment[rest]]))
    scale = design.scale[:nb]
    schur = (gram[bodies, bodies] - gram[bodies, rest] @ around[:, :-1]) * scale[:, None] * scale
    wanted = (moment[bodies] - gram[bodies, rest] @ around[:, -1]) * scale
    schur = 0.5 * (schur + schur.T)
    found = fit_consistent(schur, wanted + schur @ modelled.ravel(), rounded(modelled), weight=weight)
    change = (found - modelled).ravel() * scale
    return np.concatenate([change, around[:, -1] - around[:, :-1] @ change]), found - modelled


def rounded(modelled: np.ndarray) -> np.ndarray:
    """Links made rounder, and balls for those that the model has no mass for, shape (k, 10): all of them consistent.

    Models know the mass of a link better than its shape.
    """
    positive = modelled[modelled[:, 0] > 0, 0]
    lightest = LIGHTEST * float(positive.mean()) if positive.size else 1.0
    return np.array([_round(body, lightest) for body in modelled.reshape(-1, BODY)])


def _round(body: np.ndarray, lightest: float) -> np.ndarray:
    if body[0] < lightest:
        return parameters_of_body(lightest, np.zeros(3), 0.4 * lightest * RADIUS**2 * np.eye(3))
    matrix = pseudo_inertia(body)
    matrix[:3, :3] += np.trace(matrix[:3, :3]) / 3.0 * np.eye(3)
    values, vectors = np.linalg.eigh(matrix)
    return from_pseudo_inertia((vectors * np.maximum(values, 1e-6 * values.max())) @ vectors.T)
