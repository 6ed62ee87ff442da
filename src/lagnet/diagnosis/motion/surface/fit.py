"""argmin over a level surface and the point that touches it of the motion of all joints, their laws held.

x = (p, h, log k, μ): the point in the frame of its body, the surface's height, hardness and sliding friction.
Levenberg–Marquardt over rollouts of the whole arm.
"""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.motion.arm.fitting import Errors, cost_of, fit_values, robust_scales, sensitivities_of
from lagnet.diagnosis.motion.arm.rollouts import ArmRuns
from lagnet.diagnosis.motion.surface.starts import reach_of
from lagnet.rollout.surface import BODY, FRICTION, HARDNESS
from lagnet.side_by_side import side_by_side

ITERATIONS = 12  # of each round, at most
ROUGHEST = 1.5  # sliding friction
MOST_LOG_HARDNESS = 14.0  # 10⁶ N/m: a tenth of a millimetre under 100 N
LEAST_GAIN = 0.02  # of the cost by the best start, below which nothing is fitted


def coordinates_of(surface: np.ndarray) -> np.ndarray:
    """x = (p, h, log k, μ), shape (6,)."""
    return np.array([*surface[1:HARDNESS], np.log(surface[HARDNESS]), surface[FRICTION]])


def surface_of(body: float, x: np.ndarray) -> np.ndarray:
    """The surface of a body and x."""
    return np.array([body, *x[:4], np.exp(x[4]), x[5]])


def sizes_of_surface(reach: float) -> np.ndarray:
    """Typical steps of x: a twentieth of the arm's reach, a hundredth of it in height, a factor of e in hardness."""
    return np.array([*np.full(3, 0.05 * reach), 0.01 * reach, 1.0, 0.2])


def possible_surface(x: np.ndarray) -> np.ndarray:
    """The nearest x with 0 ≤ μ ≤ `ROUGHEST` and a hardness that a step resolves."""
    return np.array([*x[:4], min(x[4], MOST_LOG_HARDNESS), min(max(x[5], 0.0), ROUGHEST)])


def surface_errors(data: ArmRuns, laws: np.ndarray, body: np.ndarray | None, touching: float) -> Errors:
    """Errors of every joint as a function of x."""
    return lambda x: data.errors(laws, body, surface_of(touching, x))


def fit_surfaces(
    data: ArmRuns,
    laws: np.ndarray,
    body: np.ndarray | None,
    starts: list[np.ndarray],
    floors: np.ndarray,
    iterations: int = ITERATIONS,
) -> list[np.ndarray]:
    """For each touching body the surface of least cost, shape (len(SURFACE),); none where no start gains anything.

    Args:
        data: runs to fit.
        laws: shape (dof, len(LAW)); body: shape (10,), carried by the last link, or None.
        starts: surfaces to start from.
        floors: shape (joints,), resolution of the errors [rad].
        iterations: of each round, at most.
    """
    free = data.errors(laws, body)
    scales = robust_scales(free, floors)
    costs = side_by_side(lambda s: cost_of(data.errors(laws, body, s), scales), starts)
    before, sizes = cost_of(free, scales), sizes_of_surface(reach_of(data.problem.tree))

    def fitted(touching: float) -> np.ndarray | None:
        best = min((i for i, s in enumerate(starts) if s[BODY] == touching), key=lambda i: costs[i])
        if costs[best] > (1.0 - LEAST_GAIN) * before:
            return None
        errors = surface_errors(data, laws, body, touching)
        x = coordinates_of(starts[best])
        slopes = sensitivities_of(errors, sizes, possible_surface)
        x = fit_values(errors, slopes, x, sizes, floors, nearest=possible_surface, iterations=iterations)
        return surface_of(touching, x)

    found = side_by_side(fitted, sorted({s[BODY] for s in starts}))
    return [surface for surface in found if surface is not None]
