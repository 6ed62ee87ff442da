"""How far recorded torques are from a model's, whatever each joint may add by itself.

misfit_j = mean (τ_j − τ̂_j)² / var τ_j, both less what an offset, dry and viscous friction and a rotor explain. The
geometric mean over joints says how well a whole reading of the recordings fits: a reading that is wrong in kind fits no
joint, and one heavy link spoils it only where it hangs.
"""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.data_quality.samples import Samples
from lagnet.types import InverseDynamics

LEAST = 0.05  # of a joint's torque: where friction is all but this, there is nothing to compare
FLOOR = 1e-3  # misfit below which better is no better
CEILING = 30.0  # beyond which worse is no worse: one joint does not outvote all others
SLOW = 0.05  # of a joint's usual speed at which the sign of dry friction turns


def own_terms(v: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Orthonormal columns of what a joint may add by itself, shape (..., n, 4), of v and a of shape (..., n)."""
    usual = np.sqrt(np.mean(v**2, axis=-1, keepdims=True))
    sign = np.tanh(v / np.maximum(SLOW * usual, 1e-12))
    columns = np.stack([np.ones_like(v), sign, v, a], axis=-1)
    columns = columns / np.maximum(np.linalg.norm(columns, axis=-2, keepdims=True), 1e-12)
    return np.linalg.qr(columns)[0]


def beside(own: np.ndarray, x: np.ndarray) -> np.ndarray:
    """A signal of shape (..., n) less its part along orthonormal columns of shape (..., n, k)."""
    return x - np.einsum("...nk,...k->...n", own, np.einsum("...nk,...n->...k", own, x))


def misfits(samples: Samples, modelled: np.ndarray) -> np.ndarray:
    """Misfit of each joint, shape (dof,).

    Args:
        samples: motion and recorded torque.
        modelled: shape (n, dof), the model's torque for that motion.
    """
    return of_joints(samples.tau.T, np.asarray(modelled).T, own_terms(samples.v.T, samples.a.T))


def of_joints(recorded: np.ndarray, modelled: np.ndarray, own: np.ndarray) -> np.ndarray:
    """Misfit of recorded and modelled torques, shape (..., n), beside own columns, shape (..., n, k): shape (...)."""
    left, there = beside(own, recorded - modelled), beside(own, recorded)
    power = np.maximum(np.mean(there**2, axis=-1), LEAST**2 * np.var(recorded, axis=-1))
    return np.mean(left**2, axis=-1) / np.maximum(power, 1e-300)


def misfit(samples: Samples, modelled: np.ndarray) -> float:
    """Geometric mean of the joints' misfits."""
    return float(whole(misfits(samples, modelled)))


def whole(left: np.ndarray) -> np.ndarray:
    """Geometric mean over the last axis, each within what counts."""
    finite = np.where(np.isfinite(left), left, CEILING)
    return np.exp(np.mean(np.log(np.clip(finite, FLOOR, CEILING)), axis=-1))


def misfit_of(model: InverseDynamics, samples: Samples) -> float:
    """Geometric mean of the joints' misfits to a model; the ceiling where it gives no numbers."""
    torque = np.asarray(model.inverse_dynamics(samples.q, samples.v, samples.a))
    return misfit(samples, torque) if np.isfinite(torque).all() else CEILING
