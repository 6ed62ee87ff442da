"""argmin_Δπ χ²(Δπ) + w D(π + Δπ ‖ π₀) over positive definite pseudo-inertias: physically consistent bodies.

χ² is the quadratic cost of a change of bodies with all other unknowns refitted, D the log-determinant divergence from
the modelled links made rounder, w at most one nat a unit: directions that the recordings leave open stay as modelled.
How far links are drawn towards the model is decided by blocks of the recordings that are held out.
Source: Wensing 2018, Lee 2020.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress

import numpy as np

from lagnet.diagnosis.identified.design import Design
from lagnet.diagnosis.identified.equations import JointEquations
from lagnet.diagnosis.identified.folds import Choice, block_folds
from lagnet.rigid_body.consistent_fit import consistent_path
from lagnet.rigid_body.inertia import BODY, from_pseudo_inertia, parameters_of_body, pseudo_inertia

NATS = (1.0, 0.1, 0.01, 0.001)  # w, nats per unit of divergence: the next where it predicts held-out blocks better
GAIN, SURE = 0.02, 2.0  # of their error, summed over joints, and standard errors of their mean, that it must gain
LIGHTEST = 0.1  # of the mean mass of the links: a lighter one may be one that the model has no mass for
RADIUS = 0.1  # [m] of the ball that replaces such a link
FAR = 3.0  # times the modelled links, all together: lighter or heavier ones are drawn towards links of the found size
ROUNDING = 1e-9  # of the sum of the sizes of all terms: a smaller sum is what rounding leaves
WORSE = 1.5  # largest squared error of a joint over that of unconstrained parameters: beyond, bodies are not the cause


def consistent_unknowns(
    design: Design, sums: Sequence[JointEquations], choice: Choice, modelled: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Scaled unknowns with physically consistent bodies, or those of the ridge where consistent ones fit far worse.

    Args:
        design: the equations.
        sums: their normal equations.
        choice: the ridge's solution.
        modelled: shape (dof, 10), parameters π of the links that are changed.

    Returns:
        The unknowns, shape (n_unknowns,), and Δπ, shape (dof, 10), which also has parameters that the motion does not
        excite.
    """
    modelled, free = np.asarray(modelled, dtype=float), choice.ridge.x
    limit = WORSE * squared_errors(design, sums, free)
    fits = _constrained(design, sums, choice, modelled)
    folds = block_folds(design)
    parts = [_constrained(design, f.fitted, choice, modelled) for f in folds]
    found = []
    for (x, bodies), *of_folds in zip(fits, *parts, strict=False):
        if np.all(squared_errors(design, sums, x) <= limit):
            errors = [squared_errors(design, f.held_out, part) for f, (part, _) in zip(folds, of_folds, strict=True)]
            found.append((x, bodies, np.array(errors)))
    if not found:
        return free, design.unscaled(free)[: design.n_bodies].reshape(-1, BODY)
    best = found[0]
    for other in found[1:]:
        if predicts_better(other[2], best[2]):
            best = other
    return best[0], best[1]


def predicts_better(other: np.ndarray, best: np.ndarray) -> bool:
    """Whether blocks agree that links drawn less towards the model predict better, all joints together.

    Motion that shows little of the links has few blocks that agree, and what is fitted to it holds nowhere else.

    Args:
        other, best: squared errors of each joint on held-out blocks, shape (blocks, dof).
    """
    gain = np.sum((best - other) / np.maximum(best.mean(axis=0), 1e-300), axis=1)  # of each block
    scatter = float(gain.std(ddof=1)) / np.sqrt(len(gain))
    return float(gain.mean()) > max(GAIN, SURE * scatter)


def squared_errors(design: Design, sums: Sequence[JointEquations], x: np.ndarray) -> np.ndarray:
    """Σ r² of each joint over the fitted rows for scaled unknowns x, shape (dof,)."""
    return np.array([s.error(x[j.unknowns]) for s, j in zip(sums, design.joints, strict=True)])


def _constrained(
    design: Design, sums: Sequence[JointEquations], choice: Choice, modelled: np.ndarray
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """The unknowns and Δπ for each weight, as far as numbers allow."""
    n, nb, ridge = design.n_unknowns, design.n_bodies, choice.ridge
    gram, moment = np.zeros((n, n)), np.zeros(n)
    for s, joint, power in zip(sums, design.joints, ridge.variance * choice.inefficiency, strict=True):
        gram[np.ix_(joint.unknowns, joint.unknowns)] += s.gram / power
        moment[joint.unknowns] += s.moment / power
    bodies, others = slice(0, nb), slice(nb, n)
    inner = gram[others, others] + np.diag(ridge.precision[others])
    scale = design.scale[:nb]
    with suppress(np.linalg.LinAlgError):
        refitted = np.linalg.solve(inner, np.column_stack([gram[others, bodies], moment[others]]))
        schur = (gram[bodies, bodies] - gram[bodies, others] @ refitted[:, :-1]) * scale[:, None] * scale
        reduced = (moment[bodies] - gram[bodies, others] @ refitted[:, -1]) * scale
        schur = 0.5 * (schur + schur.T)
        moment_of_links = reduced + schur @ modelled.ravel()
        prior = towards_found_size(schur, moment_of_links, rounded(modelled))
        for found in consistent_path(schur, moment_of_links, prior, NATS):
            change = (found - modelled).ravel() * scale
            yield np.concatenate([change, refitted[:, -1] - refitted[:, :-1] @ change]), found - modelled


def towards_found_size(gram: np.ndarray, moment: np.ndarray, prior: np.ndarray) -> np.ndarray:
    """s π₀ with s = argmin ½ s² π₀ᵀ G π₀ - s mᵀ π₀ where that is below a third or above three; else π₀.

    Models of unknown masses hold a kilogram, a gram or nothing in the place of each. Where the recordings say nothing
    of them all together, π₀ᵀ G π₀ is what rounding leaves, and so is s.
    """
    links = prior.ravel()
    told = float(links @ gram @ links)
    if told <= ROUNDING * float(np.abs(links) @ np.abs(gram) @ np.abs(links)):
        return prior
    size = float(moment @ links) / told
    return prior if size <= 0.0 or 1.0 / FAR <= size <= FAR else size * prior


def rounded(modelled: np.ndarray) -> np.ndarray:
    """π₀, shape (k, 10): links with Σ + ⅓ tr Σ 1 for their second moment Σ, balls for links without mass.

    All are physically consistent. Models know the mass of a link better than its shape.
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
