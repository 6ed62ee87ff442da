"""95 % intervals of a payload's mass and centre: of (m, h) by rollouts of the whole arm, c = h/m to first order."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.motion.arm.fitting import sensitivities_of
from lagnet.diagnosis.motion.arm.intervals import half_widths
from lagnet.diagnosis.motion.arm.rollouts import ArmRuns
from lagnet.diagnosis.motion.payload.fit import FARTHEST, body_of

NAMES = ("m", "cx", "cy", "cz")


def point_intervals(
    fit: ArmRuns, laws: np.ndarray, point: np.ndarray, sizes: np.ndarray, floors: np.ndarray
) -> tuple[dict[str, float], dict[str, tuple[float, float]]]:
    """m [kg] and c [m], and their 95 % intervals, by name; what no joint shows is anywhere within `FARTHEST`.

    Args:
        fit: the runs that were fitted.
        laws: shape (dof, len(LAW)).
        point: (m, h), shape (4,); sizes: their typical sizes.
        floors: shape (joints,), resolution of the errors [rad].
    """

    def errors(x: np.ndarray) -> list[np.ndarray]:
        return fit.errors(laws, body_of(x))

    here = errors(point)
    m, c = float(point[0]), point[1:] / point[0]
    to_values = np.vstack([np.eye(4)[0], np.hstack([-c[:, None] / m, np.eye(3) / m])]) * sizes
    half, unseen = half_widths(here, sensitivities_of(errors, sizes)(point, here), floors, to_values)
    half = half + np.abs(to_values @ unseen).sum(axis=1) * FARTHEST * m / sizes[1]
    values: dict[str, float] = dict(zip(NAMES, map(float, [m, *c]), strict=True))
    out = {n: (values[n] - float(w), values[n] + float(w)) for n, w in zip(NAMES, half, strict=True)}
    out["m"] = (max(0.0, out["m"][0]), out["m"][1])
    return values, out
