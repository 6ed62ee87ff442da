"""What another mounting and any body on the last link would leave of a misfit: the rival of every reading."""

from __future__ import annotations

from typing import Any

import numpy as np

from lagnet.diagnosis.data_quality.check import Evidence
from lagnet.diagnosis.data_quality.misfit import LEAST, beside, own_terms, whole
from lagnet.diagnosis.data_quality.samples import Samples

UP = np.concatenate([np.eye(3), -np.eye(3)])


def left_by_physics(evidence: Evidence) -> float:
    """Least misfit of the arm as mounted, upright, upside down or sideways, with any body on its last link."""
    model: Any = evidence.model
    samples = evidence.many
    if not hasattr(model, "link_regressor"):
        return evidence.as_recorded
    models = [model]
    if hasattr(model, "with_gravity"):
        size = float(np.linalg.norm(np.asarray(model.gravity, dtype=float))) or 9.81
        models += [model.with_gravity(size * way) for way in UP]
    return min(_with_body(one, samples) for one in models)


def _with_body(model: Any, samples: Samples) -> float:
    """Misfit with the body on the last link that fits best, each joint counted by its own torque."""
    left = samples.tau - model.inverse_dynamics(samples.q, samples.v, samples.a)
    body = model.link_regressor(model.n_dof - 1, samples.q, samples.v, samples.a)
    own = own_terms(samples.v.T, samples.a.T)
    there = beside(own, samples.tau.T)
    power = np.maximum(np.mean(there**2, axis=1), LEAST**2 * np.var(samples.tau, axis=0))
    size = np.sqrt(np.maximum(power, 1e-300))[:, None]
    rest = beside(own, left.T) / size
    columns = np.stack([beside(own, body[..., k].T) / size for k in range(body.shape[2])], axis=-1)
    table = columns.reshape(-1, columns.shape[-1])
    fitted, *_ = np.linalg.lstsq(table, rest.ravel(), rcond=1e-9)
    return float(whole(np.mean((rest - columns @ fitted) ** 2, axis=1)))
