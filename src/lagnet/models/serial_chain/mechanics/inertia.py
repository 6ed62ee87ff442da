"""Ten inertial parameters a link as the entries of one symmetric 4 × 4 matrix, in which the dynamics are simplest.

The pseudo-inertia J = [[Σ, h], [hᵀ, m]] holds the second moments Σ = ∫ r rᵀ dm, the first moments h = ∫ r dm and the
mass: the "moments" of a link. Elsewhere in the package a link is given by mass, first moments and rotational inertia;
the maps between the two are linear. Source: Wensing et al. 2018.
"""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from lagnet.rigid_body import inertia as standard

# Order of a link's ten moments: Σxx Σyy Σzz Σxy Σxz Σyz hx hy hz m, as (row, column) of the pseudo-inertia.
ENTRIES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2), (0, 3), (1, 3), (2, 3), (3, 3))
ROWS, COLUMNS = (np.array(part) for part in zip(*ENTRIES, strict=True))
OFF_DIAGONAL = ROWS != COLUMNS


def pseudo_inertia(moments: Float[Array, "links 10"]) -> Float[Array, "links 4 4"]:
    """Lay ten moments a link out as the symmetric matrix J."""
    empty = jnp.zeros((moments.shape[0], 4, 4), moments.dtype)
    return empty.at[:, ROWS, COLUMNS].set(moments).at[:, COLUMNS, ROWS].set(moments)


def to_standard(moments: np.ndarray) -> np.ndarray:
    """Moments (…, 10) as m [kg], mc [kg m] and rotational inertia about the frame's origin [kg m²] (…, 10)."""
    return moments @ _TO_STANDARD.T


def from_standard(parameters: np.ndarray) -> np.ndarray:
    """The inverse of `to_standard`."""
    return parameters @ _FROM_STANDARD.T


def regressor_to_standard(columns: np.ndarray) -> np.ndarray:
    """Regressor columns (…, 10) of the moments as columns of the parameters of `to_standard`."""
    return columns @ _FROM_STANDARD


def _unit_moments() -> np.ndarray:
    """The pseudo-inertia of each moment alone, shape (10, 4, 4)."""
    out = np.zeros((10, 4, 4))
    out[np.arange(10), ROWS, COLUMNS] = 1.0
    out[np.arange(10), COLUMNS, ROWS] = 1.0
    return out


_TO_STANDARD = standard.from_pseudo_inertia(_unit_moments()).T
_FROM_STANDARD = np.linalg.inv(_TO_STANDARD)
