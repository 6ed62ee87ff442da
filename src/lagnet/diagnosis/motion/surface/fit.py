"""argmin over a level surface and the point that touches it of the motion of all joints, their laws held.

x = (p, h, log k, μ): the point in the frame of its body, the surface's height, hardness and sliding friction.
Levenberg–Marquardt over rollouts of the whole arm.
"""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.motion.arm.fitting import Errors, cost_of, fit_values, robust_scales, sensitivities_of
from lagnet.diagnosis.motion.surface.free_motion import FreeMotion
from lagnet.diagnosis.motion.surface.starts import reach_of
from lagnet.rollout.surface import BODY, FRICTION, HARDNESS, HEIGHT
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


def surface_errors(free: FreeMotion, touching: float) -> Errors:
    """Errors of every joint as a function of x."""
    return lambda x: free.errors(surface_of(touching, x))


def fit_surfaces(
    free: FreeMotion, starts: list[np.ndarray], floors: np.ndarray, iterations: int = ITERATIONS
) -> list[np.ndarray]:
    """For each touching body the surface of least cost, shape (len(SURFACE),); none where no start gains anything.

    From each point of a body the best start is fitted: which of them ends lower is not known before.

    Args:
        free: runs to fit, as the laws predict them without a surface.
        starts: surfaces to start from.
        floors: shape (joints,), resolution of the errors [rad].
        iterations: of each round, at most.
    """
    scales = robust_scales(free.errors(), floors)

    def cost(surface: np.ndarray) -> float:
        return cost_of(free.errors(surface), scales)

    most, sizes = (
        (1.0 - LEAST_GAIN) * cost_of(free.errors(), scales),
        sizes_of_surface(reach_of(free.data.problem.tree)),
    )
    begun = _best_of_points(starts, side_by_side(cost, starts), most)

    def fitted(start: np.ndarray) -> tuple[float, np.ndarray]:
        errors, x = surface_errors(free, start[BODY]), coordinates_of(start)
        slopes = sensitivities_of(errors, sizes, possible_surface)
        x = fit_values(errors, slopes, x, sizes, floors, nearest=possible_surface, iterations=iterations)
        surface = surface_of(start[BODY], x)
        return cost(surface), surface

    found = side_by_side(fitted, begun)
    own = ([f for f in found if f[1][BODY] == body] for body in sorted({s[BODY] for s in begun}))
    return [min(surfaces, key=lambda f: f[0])[1] for surfaces in own]


def _best_of_points(starts: list[np.ndarray], costs: list[float], most: float) -> list[np.ndarray]:
    """Of every point of a body the start of least cost, where that is at most `most`."""
    best: dict[tuple[float, ...], tuple[float, np.ndarray]] = {}
    for start, cost in zip(starts, costs, strict=True):
        point = tuple(start[:HEIGHT])
        if cost <= most and (point not in best or cost < best[point][0]):
            best[point] = (cost, start)
    return [start for _, start in best.values()]
