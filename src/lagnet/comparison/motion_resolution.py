"""What recorded motion says of the servo parameters in which sets differ: a fit of those alone, with its errors.

The other parameters stay at those of the best set. Directions whose change by their own size moves the joint by less
than the encoder shows are not estimated: gain, friction and inertia in one proportion move a joint without load alike.
"""

from __future__ import annotations

import numpy as np

from lagnet.comparison.differences import Difference
from lagnet.diagnosis.motion.joint.cases import LEAST_ERROR, encoder_step
from lagnet.diagnosis.motion.joint.fitting import (
    HUBER,
    Coordinates,
    JointData,
    fit_law,
    robust_scale,
    sensitivities,
)
from lagnet.servos.parameters import LAW, NO_LIMIT

ITERATIONS = 25  # of a fit from each set: published values are far from each other
SAME = 1e-9  # of a parameter's size: no difference
STEPS = 2.0  # times half an encoder step, by which a direction moves the joint that is shown
ALONG = 1e-3  # share of a parameter in a direction that is not shown, from which it is not shown itself


def joint_differences(joint: str, data: JointData, laws: np.ndarray, best: int) -> list[Difference]:
    """Every law parameter in which the sets differ at a joint; laws of shape (sets, len(LAW)).

    Args:
        joint: its name.
        data: rollouts with the bodies of the best set.
        laws: of all sets.
        best: the set whose other parameters are kept; the fit starts from the values of each.
    """
    size = np.max(np.abs(laws), axis=0)
    at = [k for k in range(len(LAW)) if np.ptp(laws[:, k]) > SAME * max(float(size[k]), 1e-12)]
    if not at:
        return []
    limited = np.where(size >= NO_LIMIT, np.min(np.abs(laws), axis=0), size)
    coordinates = Coordinates(tuple((LAW[k].name,) for k in at), limited[at])
    floor = max(0.5 * encoder_step(data.series.q), LEAST_ERROR)
    starts = [coordinates.write(laws[best], laws[m, at])[0] for m in range(len(laws))]
    scale = robust_scale(data.errors(laws[best]), floor)
    fits = [fit_law(data, law, coordinates, scale=scale, iterations=ITERATIONS, patient=True) for law in starts]
    fitted = min(fits, key=lambda fit: fit.cost)
    scale = robust_scale(fitted.residual, floor)
    fitted = fit_law(data, fitted.law, coordinates, scale=scale, iterations=ITERATIONS, patient=True)
    scale = robust_scale(fitted.residual, floor)
    error = standard_errors(data, fitted.law, coordinates, scale, floor)
    return [
        Difference(
            f"{LAW[k].name}({joint})",
            LAW[k].unit,
            tuple(float(v) for v in laws[:, k]),
            float(fitted.law[k]) if np.isfinite(error[i]) else float("nan"),
            float(error[i]),
        )
        for i, k in enumerate(at)
    ]


def standard_errors(
    data: JointData, law: np.ndarray, coordinates: Coordinates, scale: float, floor: float
) -> np.ndarray:
    """Standard errors of the coordinates, shape (k,), by the sandwich of rollouts' scores; inf where not shown.

    Args:
        data: rollouts.
        law: where they are taken.
        coordinates: the free parameters.
        scale: robust scale of the residual [rad].
        floor: what the encoder shows [rad].
    """
    predicted = data.predict(law)[0]
    jacobian = sensitivities(data, coordinates, law, predicted)
    residual = predicted - data.series.q
    weight = 1.0 / np.maximum(1.0, np.abs(residual) / (HUBER * scale))
    normal = (jacobian * weight[:, None]).T @ jacobian
    strength, axes = np.linalg.eigh(normal)
    shown = strength > (STEPS * floor) ** 2 * float(weight.sum())
    if not shown.any():
        return np.full(len(normal), np.inf)
    inverse = (axes[:, shown] / strength[shown]) @ axes[:, shown].T
    rows = zip(data.windows.first, data.windows.last, strict=True)
    scores = np.array([jacobian[a : b + 1].T @ (weight[a : b + 1] * residual[a : b + 1]) for a, b in rows])
    count = len(scores)
    covariance = inverse @ (scores.T @ scores) @ inverse * count / max(1, count - len(normal))
    systematic = np.abs((jacobian * weight[:, None]) @ inverse).sum(axis=0) * floor
    error = (np.sqrt(np.maximum(np.diag(covariance), 0.0)) + systematic) * coordinates.sizes
    error[np.sum(axes[:, ~shown] ** 2, axis=1) > ALONG] = np.inf
    return error
