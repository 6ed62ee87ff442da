"""Cov = H⁻¹ S H⁻¹, the sandwich covariance of a law's parameters, and 95 % intervals.

H is the Gauss–Newton matrix and S the covariance of the windows' scores: residuals of a rollout are correlated and not
those of the law alone, so that samples are not independent. Errors of a part of the encoder's step that have the same
sign wherever a parameter has its effect do not average out: Σ |H⁻¹ Jᵀ| δ is added to the half-width, with δ half the
resolution. Source: White 1982.
"""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.motion.joint.fitting import HUBER, Coordinates, JointData, sensitivities

NORMAL_95 = 1.96


def law_intervals(
    data: JointData, law: np.ndarray, coordinates: Coordinates, scale: float, resolution: float = 0.0
) -> dict[str, tuple[float, float]]:
    """95 % interval of every free law parameter, by name; scale and resolution of the residual in rad."""
    if not coordinates.groups:
        return {}
    predicted = data.predict(law)[0]
    jacobian = sensitivities(data, coordinates, law, predicted)
    residual = predicted - data.series.q
    weight = 1.0 / np.maximum(1.0, np.abs(residual) / (HUBER * scale))
    rows = zip(data.windows.first, data.windows.last, strict=True)
    scores = np.array([jacobian[a : b + 1].T @ (weight[a : b + 1] * residual[a : b + 1]) for a, b in rows])
    normal = (jacobian * weight[:, None]).T @ jacobian
    ridge = 1e-9 * max(float(np.trace(normal)), 1e-30) / len(normal)
    inverse = np.linalg.inv(normal + ridge * np.eye(len(normal)))
    count = len(scores)
    centred = scores - scores.mean(axis=0)
    covariance = inverse @ (centred.T @ centred) @ inverse * count / max(1, count - len(normal))
    scatter = NORMAL_95 * np.sqrt(np.maximum(np.diag(covariance), 0.0))
    systematic = np.abs((jacobian * weight[:, None]) @ inverse).sum(axis=0) * 0.5 * resolution
    half = (scatter + systematic) * coordinates.sizes
    values = coordinates.read(law)
    out = {}
    for group, value, width in zip(coordinates.groups, values, half, strict=True):
        for name in group:
            out[name] = (float(value - width), float(value + width))
    return out
