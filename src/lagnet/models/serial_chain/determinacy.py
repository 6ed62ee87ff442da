"""Which constants of the arm the recorded motion determines, and how well.

Many moments act only in fixed combinations, and the place of an origin along its axis not at all. The derivative of the
torque by every constant has dependent columns there; a singular value decomposition tells a constant that no null vector
touches, which is determined by itself, from one that can be traded against others. Source: Gautier 1991 (base parameters).
"""

from __future__ import annotations

from dataclasses import dataclass

import jax
import jax.numpy as jnp
import numpy as np

from lagnet.models.serial_chain.inertia import regressor_to_standard
from lagnet.models.serial_chain.unknowns import Unknowns

RANK = 1e-6  # singular values, columns scaled to one, below which a direction has no effect: rounding in x leaves 1e-8
TOUCHED = 1e-4  # share of a null vector, columns scaled to one, above which a constant can be traded
MOST_SAMPLES = 1000


@dataclass(frozen=True, eq=False)
class Determinacy:
    """What torque says about the constants.

    Args:
        base_rank: independent combinations of inertial parameters and joint terms, the shape being known.
        shape_rank: further independent combinations when the shape is unknown too.
        determined: shape (dof, 10), inertial parameters determined singly, the shape being known.
        deviation: shape (dof, 10), standard deviation of those parameters from the noise; inf where not determined.
        terms_determined: shape (terms, dof), likewise for joint terms.
        base_matrix: shape (base_rank, 10 dof + terms × dof), orthonormal rows that span what is determined, columns scaled.
    """

    base_rank: int
    shape_rank: int
    determined: np.ndarray
    deviation: np.ndarray
    terms_determined: np.ndarray
    base_matrix: np.ndarray


def determinacy(
    unknowns: Unknowns, x: np.ndarray, w: np.ndarray, motion: tuple[np.ndarray, ...], noise: np.ndarray
) -> Determinacy:
    """Count and mark what the motion determines.

    Args:
        unknowns: joints and their terms.
        x, w: constants found.
        motion: q, v, a, each of shape (n, dof).
        noise: shape (dof,), standard deviation of each joint's torque noise [N m].
    """
    n, links = motion[0].shape[0], 10 * unknowns.n_dof
    rows = np.linspace(0, n - 1, min(n, MOST_SAMPLES)).astype(int)
    samples = tuple(jnp.asarray(part[rows]) for part in motion)
    columns, slopes = _derivatives(unknowns, jnp.asarray(x), jnp.asarray(w), samples)
    standard = regressor_to_standard(columns[..., :links].reshape(*columns.shape[:2], -1, 10))
    columns = np.concatenate([standard.reshape(*columns.shape[:2], links), columns[..., links:]], axis=-1)
    columns, slopes = (part / noise[:, None] for part in (columns, slopes))
    values, right, size = _decompose(columns.reshape(-1, columns.shape[-1]))
    rank = _rank(values)
    together = _rank(
        _decompose(np.concatenate([columns, slopes], axis=-1).reshape(columns.shape[0] * columns.shape[1], -1))[0]
    )
    free = np.linalg.norm(right[rank:], axis=0) < TOUCHED
    moving = size > 0
    spread = np.sqrt(np.sum((right[:rank] / values[:rank, None]) ** 2, axis=0) * rows.size / n)
    deviation = np.where(free & moving, spread / np.where(moving, size, 1.0), np.inf)
    known = np.isfinite(deviation)
    return Determinacy(
        rank,
        together - rank,
        known[:links].reshape(-1, 10),
        deviation[:links].reshape(-1, 10),
        known[links:].reshape(-1, unknowns.n_dof),
        right[:rank],
    )


def _derivatives(unknowns: Unknowns, x, w, samples) -> tuple[np.ndarray, np.ndarray]:
    """Torque by linear unknowns (n, dof, linear) and by shape (n, dof, shape)."""

    @jax.jit
    def both(x, w, q, v, a):
        columns = jax.vmap(lambda *s: unknowns.full_design(x, *s))(q, v, a)
        slopes = jax.vmap(lambda *s: jax.jacfwd(lambda y: unknowns.full_design(y, *s) @ w)(x))(q, v, a)
        return columns, slopes

    columns, slopes = both(x, w, *samples)
    return np.asarray(columns), np.asarray(slopes)


def _decompose(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Singular values and right vectors of the matrix with columns scaled to one, and the columns' sizes."""
    size = np.linalg.norm(matrix, axis=0)
    size = np.where(size > 1e-9 * size.max(), size, 0.0)
    scaled = np.where(size > 0, matrix / np.where(size > 0, size, 1.0), 0.0)
    _, values, right = np.linalg.svd(np.linalg.qr(scaled, mode="r"))
    return values, right, size


def _rank(values: np.ndarray) -> int:
    return int(np.sum(values > RANK * values[0]))
