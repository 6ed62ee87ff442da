"""The physically consistent bodies that fit best: least squares over positive definite pseudo-inertias.

The cost ½ πᵀ G π - mᵀ π is convex and so is the set of bodies, hence there is one minimum. It is found by Newton's
method along the barrier -log det J, which doubles as the entropic distance from a prior body: what the data say
nothing about stays where the prior is. In coordinates where the prior is the unit matrix the steps are well scaled.
Sources: Wensing 2018 (convexity); Rucker 2022.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from lagnet.rigid_body.inertia import from_pseudo_inertia, pseudo_inertia

RELATIVE_WEIGHT = (
    1e-12  # of the explained cost: noise-free parameters return to 1e-7, and it still settles what the data leave open
)
STAGES = 10.0  # factor between the weights along the path
ROUNDING = 1e-9  # of a stage
TOLERANCE = 1e-12  # of the decrement, in units of the weight
MAX_STEPS = 60  # Newton steps a weight; a handful suffice


def fit_consistent(gram: np.ndarray, moment: np.ndarray, prior: np.ndarray, weight: float | None = None) -> np.ndarray:
    """Parameters of real bodies that minimise ½ πᵀ G π - mᵀ π + weight · distance(π, prior).

    The distance is the log-determinant divergence tr(J J₀⁻¹) - log det(J J₀⁻¹) - 4, summed over bodies.

    Args:
        gram: G, shape (10 k, 10 k), positive semidefinite, e.g. YᵀY of a regressor.
        moment: m, shape (10 k,), e.g. Yᵀτ.
        prior: shape (10,) for one body or (k, 10), physically consistent.
        weight: cost per unit of distance; by default 1e-12 of the cost that the data explain.

    Returns:
        Parameters in the shape of the prior.

    Raises:
        ValueError: shapes that do not fit, or a prior that is no body.
    """
    if weight is None:
        _, scaled, pull = _in_units_of_the_prior(gram, moment, prior)
        explained = 0.5 * float(pull @ np.linalg.lstsq(scaled, pull, rcond=None)[0])
        weight = RELATIVE_WEIGHT * max(explained, np.finfo(float).tiny)
    return next(consistent_path(gram, moment, prior, [weight]))


def consistent_path(
    gram: np.ndarray, moment: np.ndarray, prior: np.ndarray, weights: Iterable[float]
) -> Iterator[np.ndarray]:
    """The bodies of `fit_consistent` for one weight after the other, each the start of the next; weights fall.

    Raises:
        ValueError: shapes that do not fit, a prior that is no body, or a weight that is not positive.
    """
    basis, gram, moment = _in_units_of_the_prior(gram, moment, prior)
    x, first = np.tile(_UNIT, (moment.size // 10, 1)), float(np.linalg.norm(moment, np.inf))
    for weight in weights:
        if weight <= 0:
            raise ValueError(f"weight is {weight}, expected a positive number")
        for stage in _path(first, weight):
            x = _newton(gram, moment, x, stage)
        first = weight / STAGES
        yield (basis @ x.ravel()).reshape(np.shape(prior))


def _in_units_of_the_prior(
    gram: np.ndarray, moment: np.ndarray, prior: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Parameters per coordinate x, and G and m of these coordinates."""
    bodies = np.atleast_2d(np.asarray(prior, dtype=float))
    gram, moment = np.asarray(gram, dtype=float), np.asarray(moment, dtype=float)
    if gram.shape != (bodies.size, bodies.size) or moment.shape != (bodies.size,):
        raise ValueError(f"gram {gram.shape} and moment {moment.shape} do not fit a prior of shape {np.shape(prior)}")
    basis = _basis(bodies)
    return basis, basis.T @ gram @ basis, basis.T @ moment


def _symmetric_basis() -> np.ndarray:
    """Ten symmetric 4 x 4 matrices, orthonormal, shape (10, 4, 4)."""
    matrices = []
    for i in range(4):
        for j in range(i, 4):
            matrix = np.zeros((4, 4))
            matrix[i, j] = matrix[j, i] = 1.0 if i == j else np.sqrt(0.5)
            matrices.append(matrix)
    return np.array(matrices)


_SYMMETRIC = _symmetric_basis()
_UNIT_BODY = _SYMMETRIC.reshape(10, 16)
_UNIT = _UNIT_BODY @ np.eye(4).ravel()


def _basis(bodies: np.ndarray) -> np.ndarray:
    """Parameters per coordinate x, where x of each prior body stands for the unit matrix; block diagonal."""
    out = np.zeros((bodies.size, bodies.size))
    for k, body in enumerate(bodies):
        try:
            factor = np.linalg.cholesky(pseudo_inertia(body))
        except np.linalg.LinAlgError:
            raise ValueError(f"prior body {k} is not physically consistent") from None
        rows = slice(10 * k, 10 * k + 10)
        out[rows, rows] = from_pseudo_inertia(factor @ _SYMMETRIC @ factor.T).T
    return out


def _path(first: float, last: float) -> np.ndarray:
    """Weights from one that holds the bodies near the prior down to the one asked for."""
    steps = max(0, int(np.ceil(np.log(max(first / last, 1.0)) / np.log(STAGES) - ROUNDING)))
    return last * STAGES ** np.arange(steps, -1, -1, dtype=float)


def _newton(gram: np.ndarray, moment: np.ndarray, x: np.ndarray, weight: float) -> np.ndarray:
    """Damped Newton steps to the minimum for one weight; x has shape (k, 10) and stays inside the cone."""
    for _ in range(MAX_STEPS):
        inverse = np.linalg.inv((x @ _UNIT_BODY).reshape(-1, 4, 4))
        pull = _UNIT - inverse.reshape(-1, 16) @ _UNIT_BODY.T
        gradient = (gram @ x.ravel() - moment) / weight + pull.ravel()
        hessian = gram / weight + _barrier_curvature(inverse)
        step = -np.linalg.solve(hessian, gradient)
        decrement = float(-gradient @ step)
        if decrement < TOLERANCE:
            break
        # full steps once close, the safe length of self-concordant functions before
        length = 1.0 if decrement < 0.0625 else 1.0 / (1.0 + np.sqrt(decrement))
        x = x + length * step.reshape(x.shape)
    return x


def _barrier_curvature(inverse: np.ndarray) -> np.ndarray:
    """Hessian of -log det, block diagonal over bodies."""
    n = len(inverse)
    turned = inverse[:, None] @ _SYMMETRIC @ inverse[:, None]
    out = np.zeros((n, 10, n, 10))
    out[np.arange(n), :, np.arange(n)] = turned.reshape(n, 10, 16) @ _UNIT_BODY.T
    return out.reshape(10 * n, 10 * n)
