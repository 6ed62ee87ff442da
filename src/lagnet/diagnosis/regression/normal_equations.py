"""G θ = m with G = Σ XᵀX, m = Σ Xᵀr: sums, pseudo-inverses, ridge solutions and bounded steps of normal equations."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from scipy.optimize import lsq_linear

RIDGE = 1e-9  # of a parameter's own power, for directions that the data do not determine
NOTHING = 1e-40  # of the largest power of a derivative: below it, a coordinate has no influence
OPEN = 1e-8  # of the power along a direction if nothing else moved: below it, a scaled eigenvalue is rounding
RANK = 1e-9  # of the largest singular value, columns scaled to one: below it, a direction is undetermined
TURNED = 1e-6  # of a coordinate's square that lies in undetermined directions: below it, it is determined


def power_of_all(residuals: Iterable[np.ndarray]) -> float:
    """Σ xᵢ² over all arrays."""
    return float(sum(np.sum(r**2) for r in residuals))


def normal(jacobian: Sequence[np.ndarray], residuals: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Gram matrix (k, k) and moment (k,) of derivatives (n, dof, k) and residuals (n, dof) of several pieces."""
    flat = [j.reshape(-1, j.shape[2]) for j in jacobian]
    gram = sum((j.T @ j for j in flat), np.zeros((flat[0].shape[1],) * 2))
    return gram, moment_of(jacobian, residuals)


def moment_of(jacobian: Sequence[np.ndarray], residuals: Sequence[np.ndarray]) -> np.ndarray:
    """Σ Jᵀr, shape (k,), of derivatives (n, dof, k) and residuals (n, dof) of several pieces."""
    parts = (j.reshape(-1, j.shape[2]).T @ r.ravel() for j, r in zip(jacobian, residuals, strict=True))
    return sum(parts, np.zeros(jacobian[0].shape[2]))


def inverse(gram: np.ndarray) -> np.ndarray:
    """G⁻¹; rows and columns of coordinates without influence are zero."""
    scaled, scale = _scaled(gram)
    return np.linalg.inv(scaled) * scale[:, None] * scale[None, :]


def ridge_solve(gram: np.ndarray, moment: np.ndarray, ridge: float) -> np.ndarray:
    """θ = (G + r diag G)⁻¹ m, batched over leading axes.

    Args:
        gram: shape (..., k, k).
        moment: shape (..., k).
        ridge: r, of a column's own power: sets directions that the data do not determine to zero.
    """
    k = gram.shape[-1]
    diagonal = np.diagonal(gram, axis1=-2, axis2=-1)
    scale = 1.0 / np.sqrt(np.maximum(diagonal, 1e-300))
    scaled = gram * scale[..., :, None] * scale[..., None, :] + ridge * np.eye(k)
    return np.linalg.solve(scaled, (moment * scale)[..., None])[..., 0] * scale


def nonnegative_solve(gram: np.ndarray, moment: np.ndarray, ridge: float, signed: np.ndarray) -> np.ndarray:
    """`ridge_solve` with θ_k ≥ 0 for signed k: those that come out below zero are held there, and the rest follows.

    None is released again, so that the error is at least that of the exact bounded optimum.

    Args:
        gram, moment, ridge: as in `ridge_solve`.
        signed: shape (k,), coefficients that are never negative.
    """
    theta, free = ridge_solve(gram, moment, ridge), np.ones(moment.shape, dtype=bool)
    while np.any(below := signed & (theta < 0.0)):
        free &= ~below
        both = free[..., :, None] & free[..., None, :]
        theta = ridge_solve(np.where(both, gram, 0.0), np.where(free, moment, 0.0), ridge)
    return theta


def leaves_open(gram: np.ndarray, powers: np.ndarray) -> bool:
    """Whether there are directions along which the residuals do not change.

    Args:
        gram: shape (k, k), where other coordinates were projected out.
        powers: shape (k,), its diagonal if nothing else moved.
    """
    values, _, scale = _eigen(gram, powers)
    return bool(np.any(values < OPEN) or np.any(scale == 0.0))


def inverse_where_told(gram: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """G⁺ on the directions that the data determine, and which coordinates lie in directions that they do not.

    Returns:
        shape (k, k), zero for coordinates without any say; and shape (k,), whether a coordinate is left open.
    """
    values, vectors, scale = _eigen(gram, np.diag(gram))
    determined = values >= OPEN
    inner = (vectors[:, determined] / values[determined]) @ vectors[:, determined].T
    return inner * scale[:, None] * scale[None, :], np.sum(vectors[:, ~determined] ** 2, axis=1) > TURNED


def _eigen(gram: np.ndarray, powers: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Eigenvalues and eigenvectors of diag(G)^(−½) G diag(G)^(−½), and that scale: zero for those without influence."""
    scale = _scale(powers)
    values, vectors = np.linalg.eigh(gram * scale[:, None] * scale[None, :] + np.diag(1.0 * (scale == 0.0)))
    return values, vectors, scale


def bounded_step(gram: np.ndarray, moment: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """argmin xᵀG x / 2 − mᵀx subject to lower ≤ x ≤ upper, shape (k,)."""
    scaled, scale = _scaled(gram)
    root = np.linalg.cholesky(scaled).T
    target = np.linalg.solve(root.T, moment * scale)
    size = np.where(scale > 0.0, scale, 1.0)
    low, high = np.minimum(lower, -1e-15) / size, np.maximum(upper, 1e-15) / size
    return lsq_linear(root, target, bounds=(low, high), method="bvls").x * scale


def _scale(power: np.ndarray) -> np.ndarray:
    scale = np.zeros(len(power))  # a coordinate without any say stays where it is
    felt = power > max(NOTHING * float(np.max(power, initial=0.0)), 1e-200)
    scale[felt] = 1.0 / np.sqrt(power[felt])
    return scale


def _scaled(gram: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    scale = _scale(np.diag(gram))
    return gram * scale[:, None] * scale[None, :] + RIDGE * np.eye(len(gram)), scale


def scaled_weights(columns: np.ndarray, wanted: np.ndarray, rank: float = RANK) -> np.ndarray:
    """argmin_w ‖X w − y‖², (k,) or (k, m), for X (n, k) and wanted y (n,) or (n, m); a column of zeros gets zero.

    Args:
        rank: of the largest singular value, columns scaled to one, below which a direction is left at zero.
    """
    if not columns.shape[1]:
        return np.zeros((0, *wanted.shape[1:]))
    size = np.linalg.norm(columns, axis=0)
    size = np.where(size > 0, size, 1.0)
    return (np.linalg.lstsq(columns / size, wanted, rcond=rank)[0].T / size).T


def left_beside(columns: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """y − X argmin_w ‖X w − y‖², shape (n,) or (n, m); arguments as in `scaled_weights`."""
    return wanted - columns @ scaled_weights(columns, wanted)
