"""The misfit with the arm mounted otherwise and any body on its last link: the rival of every other reading."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.data_quality.check import Evidence
from lagnet.diagnosis.data_quality.misfit import LEAST_SHARE, geometric_mean, nuisance_terms, without_nuisance
from lagnet.diagnosis.data_quality.samples import Samples
from lagnet.types import RigidBodyModel, has_regressor

DIRECTIONS = np.concatenate([np.eye(3), -np.eye(3)])


def misfits_with_mounting_and_body(evidence: Evidence) -> np.ndarray:
    """Misfits (dof,) of the arm as mounted, upright, upside down or sideways, with any body on its last link."""
    model = evidence.model
    if not has_regressor(model):
        return evidence.misfits
    size = float(np.linalg.norm(np.asarray(model.gravity, dtype=float))) or 9.81
    mounted = [model, *(model.with_gravity(size * direction) for direction in DIRECTIONS)]
    return min((_with_body(one, evidence.many) for one in mounted), key=geometric_mean)


def _with_body(model: RigidBodyModel, samples: Samples) -> np.ndarray:
    """Misfits (dof,) with the body Δπ on the last link that minimises them, each joint in units of its own torque."""
    residual = samples.tau - model.inverse_dynamics(samples.q, samples.v, samples.a)
    body = model.link_regressor(model.n_dof - 1, samples.q, samples.v, samples.a)
    nuisance = nuisance_terms(samples.v.T, samples.a.T)
    torque = without_nuisance(nuisance, samples.tau.T)
    power = np.maximum(np.mean(torque**2, axis=1), LEAST_SHARE**2 * np.var(samples.tau, axis=0))
    size = np.sqrt(np.maximum(power, 1e-300))[:, None]
    target = without_nuisance(nuisance, residual.T) / size
    columns = np.stack([without_nuisance(nuisance, body[..., k].T) / size for k in range(body.shape[2])], axis=-1)
    table = columns.reshape(-1, columns.shape[-1])
    fitted, *_ = np.linalg.lstsq(table, target.ravel(), rcond=1e-9)
    return np.mean((target - columns @ fitted) ** 2, axis=1)
