"""How high a surface may lie before the motion contradicts: the least cost for each height, walked from the best fit.

An arm that comes down in one orientation shows z_p − h alone: the point moved by s along the upward direction n of its
body and the surface moved by s touch alike. Along that ridge a fit is slow, and derivatives at its end see it as
steeper than it is, as they take what laws leave for signal. So heights are stepped through, all else fitted again.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.motion.arm.fitting import cost_of, fit_values, robust_scales, sensitivities_of
from lagnet.diagnosis.motion.arm.rollouts import ArmRuns
from lagnet.diagnosis.motion.surface.fit import (
    coordinates_of,
    possible_surface,
    sizes_of_surface,
    surface_errors,
    surface_of,
)
from lagnet.diagnosis.motion.surface.free_motion import FreeMotion, free_motion
from lagnet.diagnosis.motion.surface.starts import reach_of
from lagnet.rollout.surface import BODY, heights_of
from lagnet.side_by_side import side_by_side

STEPS = (0.01, 0.02, 0.04, 0.08, 0.16)  # of the arm's reach, from the best fit
ITERATIONS = 3  # at each height
SAMPLES = 2500  # in which the point comes lowest
RISE = 0.1  # of the cost: what laws leave over a contact is told no finer
CLOSE = 0.01  # of the arm's reach: a point so low touches
HEIGHT = 3  # in x


@dataclass(frozen=True, eq=False)
class Profile:
    """Surfaces by their height.

    Args:
        x: shape (n, 6), of least cost at each height, the heights increasing.
        cost: shape (n,).
    """

    x: np.ndarray
    cost: np.ndarray

    @property
    def best(self) -> np.ndarray:
        """x of least cost, shape (6,)."""
        return self.x[int(np.argmin(self.cost))]

    def ends(self) -> tuple[np.ndarray, np.ndarray]:
        """Least and greatest x among those whose cost is at most `RISE` above the least, shape (6,) each."""
        most, at = (1.0 + RISE) * float(self.cost.min()), int(np.argmin(self.cost))
        rows = [self.x[at]]
        for side in (-1, 1):
            i = at
            while 0 <= i + side < len(self.cost) and self.cost[i + side] <= most:
                i += side
                rows.append(self.x[i])
            if 0 <= i + side < len(self.cost):
                share = (most - self.cost[i]) / (self.cost[i + side] - self.cost[i])
                rows.append(self.x[i] + share * (self.x[i + side] - self.x[i]))
        return np.min(rows, axis=0), np.max(rows, axis=0)


def profile_of(free: FreeMotion, surface: np.ndarray, floors: np.ndarray) -> Profile:
    """The profile of a fitted surface.

    Args:
        free: the runs that were fitted, as the laws predict them without a surface.
        surface: the fit, shape (len(SURFACE),).
        floors: shape (joints,), resolution of the errors [rad].
    """
    x, reach = coordinates_of(surface), reach_of(free.data.problem.tree)
    data = _lowest(free.data, surface)
    free = free_motion(data, free.laws, free.body)
    errors, sizes = surface_errors(free, surface[BODY]), np.delete(sizes_of_surface(reach), HEIGHT)
    here = errors(x)
    scales, shift = robust_scales(here, floors), np.array([*upward(data, surface), 1.0, 0.0, 0.0])
    least = cost_of(here, scales)

    def at_height(start: np.ndarray) -> tuple[np.ndarray, float]:
        height = start[HEIGHT]

        def whole(v: np.ndarray) -> np.ndarray:
            return np.insert(v, HEIGHT, height)

        def nearest(v: np.ndarray) -> np.ndarray:
            return np.delete(possible_surface(whole(v)), HEIGHT)

        def of(v: np.ndarray) -> list[np.ndarray]:
            return errors(whole(v))

        slopes, begin = sensitivities_of(of, sizes, nearest), np.delete(start, HEIGHT)
        v = fit_values(of, slopes, begin, sizes, floors, nearest=nearest, iterations=ITERATIONS, rounds=1)
        return whole(v), cost_of(of(v), scales)

    def walk(side: float) -> list[tuple[np.ndarray, float]]:
        found, last, lowest = [], x, least
        for step in STEPS:
            last, cost = at_height(last + (x[HEIGHT] + side * step * reach - last[HEIGHT]) * shift)
            found.append((last, cost))
            lowest = min(lowest, cost)
            if cost > (1.0 + RISE) * lowest:
                break
        return found

    down, upwards = side_by_side(walk, [-1.0, 1.0])
    rows = [*down[::-1], (x, least), *upwards]
    return Profile(np.array([r[0] for r in rows]), np.array([r[1] for r in rows]))


def _lowest(data: ArmRuns, surface: np.ndarray) -> ArmRuns:
    """The runs in which the point comes lowest, `SAMPLES` of them."""
    q = np.column_stack([s.q for s in data.problem.series])
    z = heights_of(data.problem.tree, surface, q)
    order = sorted(data.runs, key=lambda run: float(z[run.first : run.last + 1].min()))
    within = np.cumsum([run.last - run.first + 1 for run in order]) <= SAMPLES
    return replace(data, runs=tuple(sorted(order[: max(1, int(within.sum()))], key=lambda run: run.first)))


def upward(data: ArmRuns, surface: np.ndarray) -> np.ndarray:
    """Mean upward direction in the frame of the touching body, over the poses that touch, shape (3,)."""
    tree = data.problem.tree
    q = np.column_stack([s.q for s in data.problem.series])
    q = np.concatenate([q[run.first : run.last + 1] for run in data.runs])
    z = heights_of(tree, surface, q)
    low = q[z <= max(float(z.min()), 0.0) + CLOSE * reach_of(tree)]
    origin = surface_of(surface[BODY], np.zeros(6))
    along = [heights_of(tree, origin + np.eye(len(origin))[1 + i], low) for i in range(3)]
    return np.array([float(np.mean(a - heights_of(tree, origin, low))) for a in along])
