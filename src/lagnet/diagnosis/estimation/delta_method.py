"""cov p = J cov x Jᵀ, J = ∂p/∂x: from the coordinates x of a refit to the parameters p of a verdict (delta method)."""

from __future__ import annotations

import numpy as np

from lagnet.models.corrected.named_effects import NamedEffect


def parameter_jacobian(effect: NamedEffect, x: np.ndarray) -> np.ndarray:
    """J = ∂p/∂x of an effect, shape (n_parameters, n_coordinates)."""
    here = np.array(list(effect.at_coordinates(x).parameters().values()))
    columns = []
    for k in range(x.size):
        step = 1e-6 * max(abs(x[k]), 1e-3)
        moved = x.copy()
        moved[k] += step
        there = np.array(list(effect.at_coordinates(moved).parameters().values()))
        columns.append((there - here) / step)
    return np.array(columns).T


def correlations_of(covariance: np.ndarray) -> np.ndarray:
    """Correlations of the coordinates, shape as the covariance; zeros where nothing is known."""
    variance = np.diag(covariance)
    scale = np.where(variance > 1e-200, 1.0 / np.sqrt(np.maximum(variance, 1e-200)), 0.0)
    return covariance * scale[:, None] * scale[None, :]
