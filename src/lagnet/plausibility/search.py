"""Where a statement is broken worst: random and extreme configurations, then a local search from the worst of them."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from lagnet.plausibility.subject import Subject

Measure = Callable[[np.ndarray], np.ndarray]
STEP = 1e-4  # of the half width of the box: small against its shape, large against rounding
CORNERS = 32
STEPS_A_ROUND = 2  # of the local search, at most
REACHES = (0.2, 0.05)  # of the half width: how far the neighbours of each round lie
NEIGHBOURS = 6


@dataclass(frozen=True, eq=False)
class Space:
    """Configurations as points of a cube [-1, 1]^p: which of q, v, a vary."""

    subject: Subject
    symbols: str

    @property
    def dimension(self) -> int:
        """Length p of a point."""
        return len(self.symbols) * self.subject.n_dof

    def decode(self, points: np.ndarray) -> list[np.ndarray]:
        """The arrays of `symbols`, each of shape (n, dof), at points of shape (n, p)."""
        box, out = self.subject.ranges, []
        for symbol, x in zip(self.symbols, np.split(points, len(self.symbols), axis=1), strict=True):
            if symbol == "q":
                out.append(box.lower + (box.upper - box.lower) * (x + 1) / 2)
            else:
                out.append(x * (box.velocity if symbol == "v" else box.acceleration))
        return out

    def where(self, point: np.ndarray) -> dict[str, list[float]]:
        """A point in words of the robot."""
        arrays = self.decode(point[None])
        return {s: [float(x) for x in array[0]] for s, array in zip(self.symbols, arrays, strict=True)}


@dataclass(frozen=True, eq=False)
class Worst:
    """The largest value found, and the point it was found at."""

    value: float
    point: np.ndarray
    sampled: float


def worst_configuration(
    subject: Subject, symbols: str, measure: Callable[..., np.ndarray]
) -> tuple[Worst, dict[str, list[float]]]:
    """Where `measure(q, v, a)` (those of `symbols`), shape (n,), is largest, by sampling and by local search."""
    space = Space(subject, symbols)
    worst = worst_point(subject, space.dimension, lambda points: measure(*space.decode(points)))
    return worst, space.where(worst.point)


def worst_point(subject: Subject, dimension: int, measure: Measure) -> Worst:
    """The point of the cube [-1, 1]^p where the measure is largest.

    Args:
        subject: gives seed and effort.
        dimension: p.
        measure: takes points (n, p), returns (n,).
    """
    seen = _Best(measure)
    points = starting_points(subject, dimension)
    values = seen(points)
    sampled = seen.value
    for start in points[np.argsort(values)[::-1][: subject.settings.starts]]:
        _climb(seen, start, subject.settings.iterations)
    return Worst(seen.value, seen.point, sampled)


def closer_and_closer(measure: Measure, start: np.ndarray, value: float, rng: np.random.Generator) -> Worst:
    """The worst point near a start, for measures too costly for gradients: neighbours of the worst so far, in rounds.

    Args:
        measure: takes points (n, p) of the cube, returns (n,).
        start: shape (p,), with `value` there.
        rng: of the neighbours.
    """
    point, worst = start, value
    for reach in REACHES:
        near = np.clip(point + reach * rng.standard_normal((NEIGHBOURS, start.size)), -1.0, 1.0)
        values = measure(near)
        top = int(np.argmax(values))
        if values[top] > worst:
            point, worst = near[top], float(values[top])
    return Worst(worst, point, value)


class _Best:
    """Remembers the largest of all values that were ever computed: gradients look around, too."""

    def __init__(self, measure: Measure):
        self.measure, self.value, self.point = measure, -np.inf, np.zeros(0)

    def __call__(self, points: np.ndarray) -> np.ndarray:
        values = self.measure(points)
        top = int(np.argmax(values))
        if values[top] > self.value:
            self.value, self.point = float(values[top]), points[top].copy()
        return values


def starting_points(subject: Subject, dimension: int) -> np.ndarray:
    """Centre, corners, ends of every axis, and random points: limits of joints are where models are worst."""
    rng = np.random.default_rng([subject.seed, dimension])
    corners = rng.choice([-1.0, 1.0], (CORNERS, dimension))
    axes = np.concatenate([np.eye(dimension), -np.eye(dimension)])
    whole = np.array([np.zeros(dimension), np.ones(dimension), -np.ones(dimension)])
    return np.concatenate([whole, axes, corners, rng.uniform(-1.0, 1.0, (subject.settings.samples, dimension))])


def _climb(seen: _Best, start: np.ndarray, iterations: int) -> None:
    size = max(abs(float(seen(start[None])[0])), 1e-300)
    left = iter(range(STEPS_A_ROUND * iterations))

    def downhill(x: np.ndarray) -> tuple[float, np.ndarray]:
        next(left)  # a line search among rounding errors would go on: its own limit is looked at between rounds only
        ahead, behind = np.minimum(x + STEP * np.eye(x.size), 1.0), np.maximum(x - STEP * np.eye(x.size), -1.0)
        values = -seen(np.concatenate([x[None], ahead, behind])) / size
        rise = values[1 : x.size + 1] - values[x.size + 1 :]
        return float(values[0]), rise / np.diagonal(ahead - behind)

    with suppress(StopIteration):
        minimize(
            downhill,
            start,
            jac=True,
            method="L-BFGS-B",
            bounds=[(-1.0, 1.0)] * start.size,
            options={"maxiter": iterations},
        )
