"""From random starts to the shape of an arm: axis directions by the relaxed problem, then lengths and gravity."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lagnet.models.serial_chain.identification.lifting import gravity_direction
from lagnet.models.serial_chain.identification.separable import Descent, Samples
from lagnet.models.serial_chain.identification.unknowns import Unknowns
from lagnet.models.serial_chain.settings import STANDARD_GRAVITY, SearchSettings

SAME_MINIMUM = 0.02  # relative difference of cost below which two starts are taken to have found the same minimum


@dataclass(frozen=True)
class Found:
    """Minima, best first.

    Args:
        x: shape (starts, unknowns).
        cost: shape (starts,), share of the weighted torque left over.
        linear: shape (starts, linear unknowns).
    """

    x: np.ndarray
    cost: np.ndarray
    linear: np.ndarray

    def distinct(self, most: int) -> np.ndarray:
        """Indices of the best minima that differ in cost."""
        kept = [0]
        for index in range(1, self.cost.size):
            if self.cost[index] > (1 + SAME_MINIMUM) * self.cost[kept[-1]] + 1e-9 and len(kept) < most:
                kept.append(index)
        return np.array(kept)


def search_axes(unknowns: Unknowns, samples: Samples, rng: np.random.Generator, settings: SearchSettings) -> Found:
    """Directions of the joint axes, from uniformly random angles."""
    if unknowns.n_angles == 0:
        return Found(np.zeros((1, 0)), np.ones(1), np.zeros((1, 0)))
    descent = Descent(unknowns.relaxed_design, samples, np.ones(unknowns.n_angles))
    return _search(descent, lambda: rng.uniform(-np.pi, np.pi, (settings.batch, unknowns.n_angles)), settings)


def search_lengths(
    unknowns: Unknowns,
    samples: Samples,
    axes: np.ndarray,
    lifted: np.ndarray,
    rng: np.random.Generator,
    settings: SearchSettings,
) -> Found:
    """Offsets and gravity by the full problem, with the axes near those found; everything is free to move.

    Half of the starts take gravity from the relaxed problem, half at random. A mirror image (r → −r of every vector)
    makes the sign of gravity a choice unless a prismatic joint fixes it, so both are tried.
    """

    def draw() -> np.ndarray:
        offsets = rng.normal(scale=settings.lengths, size=(settings.batch, 2 * (unknowns.n_dof - 1)))
        down = rng.normal(size=(settings.batch, 3))
        down /= np.linalg.norm(down, axis=1, keepdims=True)
        if lifted.size:
            likely = gravity_direction(lifted[: unknowns.relaxed_size], unknowns.revolute)
            down[0::4], down[1::4] = likely, -likely
        return np.hstack([np.tile(axes, (settings.batch, 1)), offsets, STANDARD_GRAVITY * down])

    return _search(Descent(unknowns.full_design, samples, unknowns.scale, unknowns.reach), draw, settings)


def _search(descent: Descent, draw: Callable[[], np.ndarray], settings: SearchSettings) -> Found:
    x, cost, linear = [], [], []
    while True:
        point = descent.run(draw(), settings.iterations, settings.exact)
        x.append(np.asarray(point.x))
        cost.append(np.nan_to_num(np.asarray(point.normal.cost), nan=np.inf) / descent.energy)
        linear.append(np.asarray(point.normal.w))
        if _believed(np.sort(np.concatenate(cost)), settings):
            break
    order = np.argsort(np.concatenate(cost))
    return Found(np.concatenate(x)[order], np.concatenate(cost)[order], np.concatenate(linear)[order])


def _believed(cost: np.ndarray, settings: SearchSettings) -> bool:
    """Whether the lowest of the sorted costs is to be taken for the lowest there is."""
    if cost[0] < settings.exact or cost.size >= settings.most_starts:
        return True
    twice = cost.size > 1 and cost[1] < (1 + SAME_MINIMUM) * cost[0]
    return bool(twice and (cost[0] < settings.convincing or cost.size >= settings.least_starts))
