"""misfit_j = mean (τ_j − τ̂_j)² / mean τ_j², both with the nuisance terms of the joint projected out.

The nuisance terms are an offset, dry and viscous friction and a rotor: a joint may have them whatever the model says.
The geometric mean over joints compares readings of the recordings: one that is wrong in kind fits no joint, while a
wrong mass of one heavy link spoils only the joints that carry it.
"""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.data_quality.samples import Samples
from lagnet.types import InverseDynamics

LEAST_SHARE = 0.05  # of a joint's torque: where friction explains more, there is nothing to compare
LOWEST = 1e-3  # misfit: below, smaller is no better
HIGHEST = 30.0  # misfit: above, larger is no worse, so that one joint does not outvote all others
SIGN_WIDTH = 0.05  # of a joint's root mean square speed: width of the smooth sign of dry friction


def nuisance_terms(v: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Orthonormal columns that span 1, sign v, v and a of a joint, shape (..., n, 4); v and a of shape (..., n)."""
    usual = np.sqrt(np.mean(v**2, axis=-1, keepdims=True))
    sign = np.tanh(v / np.maximum(SIGN_WIDTH * usual, 1e-12))
    columns = np.stack([np.ones_like(v), sign, v, a], axis=-1)
    columns = columns / np.maximum(np.linalg.norm(columns, axis=-2, keepdims=True), 1e-12)
    return np.linalg.qr(columns)[0]


def without_nuisance(nuisance: np.ndarray, x: np.ndarray) -> np.ndarray:
    """x − N Nᵀ x, a signal of shape (..., n) less its part along orthonormal columns N of shape (..., n, k)."""
    return x - np.einsum("...nk,...k->...n", nuisance, np.einsum("...nk,...n->...k", nuisance, x))


def misfits(samples: Samples, modelled: np.ndarray) -> np.ndarray:
    """Misfit of each joint, shape (dof,).

    Args:
        samples: motion and recorded torque.
        modelled: shape (n, dof), the model's torque for that motion.
    """
    return joint_misfits(samples.tau.T, np.asarray(modelled).T, nuisance_terms(samples.v.T, samples.a.T))


def joint_misfits(recorded: np.ndarray, modelled: np.ndarray, nuisance: np.ndarray) -> np.ndarray:
    """Misfit of each joint, shape (...).

    Args:
        recorded, modelled: torques, shape (..., n).
        nuisance: orthonormal columns of the nuisance terms, shape (..., n, k).
    """
    residual, torque = without_nuisance(nuisance, recorded - modelled), without_nuisance(nuisance, recorded)
    power = np.maximum(np.mean(torque**2, axis=-1), LEAST_SHARE**2 * np.var(recorded, axis=-1))
    return np.mean(residual**2, axis=-1) / np.maximum(power, 1e-300)


def geometric_mean(misfit: np.ndarray) -> np.ndarray:
    """exp mean log over the last axis, of misfits cut to [LOWEST, HIGHEST]."""
    finite = np.where(np.isfinite(misfit), misfit, HIGHEST)
    return np.exp(np.mean(np.log(np.clip(finite, LOWEST, HIGHEST)), axis=-1))


def misfits_of(model: InverseDynamics, samples: Samples) -> np.ndarray:
    """Misfit of each joint to a model, shape (dof,); HIGHEST where the model's torque is not finite."""
    torque = np.asarray(model.inverse_dynamics(samples.q, samples.v, samples.a))
    if not np.isfinite(torque).all():
        return np.full(samples.tau.shape[1], HIGHEST)
    return misfits(samples, torque)


def misfit_of(model: InverseDynamics, samples: Samples) -> float:
    """Geometric mean of the joints' misfits to a model."""
    return float(geometric_mean(misfits_of(model, samples)))
