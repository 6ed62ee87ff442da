"""95 % intervals of a payload's mass and centre: the sandwich covariance of (m, h), and c = h/m to first order.

As in `intervals`: scores over blocks of time, whose errors are correlated within, and half an encoder step that errs to
one side. Source: White 1982.
"""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.motion.fitting import HUBER, robust_scale
from lagnet.diagnosis.motion.intervals import NORMAL_95
from lagnet.diagnosis.motion.payload.arm_rollout import ArmRuns
from lagnet.diagnosis.motion.payload.fit import FARTHEST, body_of, sensitivities_of

BLOCKS = 40  # of time
UNSEEN = 1e-6  # of the largest eigenvalue of the normal matrix: what no joint shows is anywhere within `FARTHEST`
NAMES = ("m", "cx", "cy", "cz")


def point_intervals(
    fit: ArmRuns, laws: np.ndarray, point: np.ndarray, sizes: np.ndarray, floors: np.ndarray
) -> tuple[dict[str, float], dict[str, tuple[float, float]]]:
    """m [kg] and c [m], and their 95 % intervals, by name.

    Args:
        fit: the runs that were fitted.
        laws: shape (dof, len(LAW)).
        point: (m, h), shape (4,); sizes: their typical sizes.
        floors: shape (joints,), resolution of the errors [rad].
    """

    def errors(x: np.ndarray) -> list[np.ndarray]:
        return fit.errors(laws, body_of(x))

    normal, scores, systematic = np.zeros((4, 4)), np.zeros((BLOCKS, 4)), []
    for e, jacobian, floor in zip(errors(point), sensitivities_of(errors, point, sizes), floors, strict=True):
        scale = robust_scale(e, floor)
        weight = 1.0 / np.maximum(1.0, np.abs(e) / (HUBER * scale)) / scale**2
        weighted = jacobian * weight[:, None]
        normal += weighted.T @ jacobian
        scores += np.array([b.sum(axis=0) for b in np.array_split(weighted * e[:, None], BLOCKS)])
        systematic.append((weighted, 0.5 * floor))
    power, vectors = np.linalg.eigh(normal)
    seen = power > UNSEEN * power[-1]
    inverse = (vectors[:, seen] / power[seen]) @ vectors[:, seen].T
    m, c = float(point[0]), point[1:] / point[0]
    to_values = np.vstack([np.eye(4)[0], np.hstack([-c[:, None] / m, np.eye(3) / m])]) * sizes
    spread = to_values @ inverse
    centred = scores - scores.mean(axis=0)
    variance = np.diag(spread @ (centred.T @ centred) @ spread.T) * BLOCKS / (BLOCKS - 4.0)
    half = NORMAL_95 * np.sqrt(np.maximum(variance, 0.0))
    half = half + sum(np.abs(weighted @ spread.T).sum(axis=0) * step for weighted, step in systematic)
    half = half + np.abs(to_values @ vectors[:, ~seen]).sum(axis=1) * FARTHEST * m / sizes[1]
    values: dict[str, float] = dict(zip(NAMES, map(float, [m, *c]), strict=True))
    out = {n: (values[n] - float(w), values[n] + float(w)) for n, w in zip(NAMES, half, strict=True)}
    out["m"] = (max(0.0, out["m"][0]), out["m"][1])
    return values, {str(name): ends for name, ends in out.items()}
