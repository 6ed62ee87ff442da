"""Which constants of the arm the recorded motion determines, and how well.

Many moments act only in fixed combinations, and the place of an origin along its axis not at all. The derivative of the
torque by every constant has dependent columns there; the eigenvectors of its Gram matrix tell a constant that no null
vector touches, which is determined by itself, from one that can be traded against others. Source: Gautier 1991 (base
parameters).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag

from lagnet.models.serial_chain.mechanics.inertia import regressor_to_standard

RANK = 1e-12  # of the largest eigenvalue, columns scaled to one: rounding leaves 1e-15, weak but real effects 1e-10
TOUCHED = 1e-4  # share of a null vector, columns scaled to one, above which a constant can be traded


@dataclass(frozen=True, eq=False)
class Determinacy:
    """What torque says about the constants.

    Args:
        base_rank: independent combinations of inertial parameters and joint terms, the shape being known.
        shape_rank: further independent combinations when the shape is unknown too.
        determined: shape (dof, 10), inertial parameters determined singly, the shape being known.
        deviation: shape (dof, 10), their standard deviation from the noise; inf where not determined.
        terms_determined: shape (terms, dof), likewise for joint terms.
        base_matrix: shape (base_rank, 10 dof + terms × dof), rows spanning the determined combinations of inertial
            parameters and joint terms; a base parameter is a row times them.
    """

    base_rank: int
    shape_rank: int
    determined: np.ndarray
    deviation: np.ndarray
    terms_determined: np.ndarray
    base_matrix: np.ndarray


def determinacy(gram: np.ndarray, n_dof: int, n_terms: int) -> Determinacy:
    """Count and mark what the motion determines.

    Args:
        gram: DᵀD of the torque's derivative by moments, joint terms and shape, torque in units of its noise.
        n_dof: joints.
        n_terms: joint terms, each with one coefficient a joint.
    """
    links, linear = 10 * n_dof, (10 + n_terms) * n_dof
    to_standard = regressor_to_standard(np.eye(10))
    change = block_diag(*([to_standard] * n_dof), np.eye(gram.shape[0] - links))
    gram = change.T @ gram @ change
    values, vectors, size = _spectrum(gram[:linear, :linear])
    kept = _kept(values)
    together = int(np.sum(_kept(_spectrum(gram)[0])))
    traded = np.linalg.norm(vectors[:, ~kept], axis=1) > TOUCHED
    spread = np.sqrt(np.sum(vectors[:, kept] ** 2 / values[kept], axis=1))
    known = ~traded & (size > 0)
    deviation = np.where(known, spread / np.where(size > 0, size, 1.0), np.inf)
    return Determinacy(
        base_rank=int(np.sum(kept)),
        shape_rank=together - int(np.sum(kept)),
        determined=known[:links].reshape(-1, 10),
        deviation=deviation[:links].reshape(-1, 10),
        terms_determined=known[links:].reshape(n_terms, n_dof),
        base_matrix=(vectors[:, kept] * size[:, None]).T,
    )


def _spectrum(gram: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Eigenvalues and vectors of the Gram matrix of columns scaled to one, and the columns' sizes."""
    size = np.sqrt(np.maximum(np.diag(gram), 0.0))
    size = np.where(size > 1e-9 * size.max(), size, 0.0)
    divide = np.where(size > 0, size, np.inf)
    values, vectors = np.linalg.eigh(gram / np.outer(divide, divide))
    return values, vectors, size


def _kept(values: np.ndarray) -> np.ndarray:
    return values > RANK * values.max()
