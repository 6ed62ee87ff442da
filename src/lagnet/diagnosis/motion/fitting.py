"""Gauss–Newton over rollouts of one joint: parameters of its law from positions alone.

Residuals are predicted less measured positions in units of `resolution`. Robust weights (Huber 1964) keep contacts,
which no law of a servo explains, from bending its parameters. Sensitivities are one-sided differences over a batch of
rollouts; a trust region (Levenberg–Marquardt) and bounds keep every law physical.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.rollout.one_joint import JointSeries, Windows, roll_out
from lagnet.servos.parameters import INDEX, LAW

HUBER = 2.0  # robust scales beyond which a residual counts linearly
NUDGE = 2e-3  # step of a difference, in units of each parameter's size
DAMPING = (1e-3, 1e-1, 1e1, 1e3)  # tried together in every iteration
PRIOR = 1e-4  # weight of staying at the start, per coordinate, so that what nothing determines stays put


@dataclass(frozen=True, eq=False)
class JointData:
    """What a joint is fitted to: its series, the windows and the longest step of integration [s]."""

    series: JointSeries
    windows: Windows
    step: float

    def predict(self, laws: np.ndarray) -> np.ndarray:
        """Positions of each law, shape (sets, n)."""
        return roll_out(laws, self.series, self.windows, self.step)

    def errors(self, law: np.ndarray) -> np.ndarray:
        """Predicted less measured positions, shape (n,) [rad]."""
        return self.predict(law)[0] - self.series.q


@dataclass(frozen=True, eq=False)
class Coordinates:
    """Law parameters that are free, each group sharing one value, and the sizes they are stepped in."""

    groups: tuple[tuple[str, ...], ...]
    sizes: np.ndarray

    @property
    def lower(self) -> np.ndarray:
        return np.array([LAW[INDEX[g[0]]].lower for g in self.groups])

    @property
    def upper(self) -> np.ndarray:
        return np.array([LAW[INDEX[g[0]]].upper for g in self.groups])

    def read(self, law: np.ndarray) -> np.ndarray:
        """Values of the groups, shape (k,)."""
        return np.array([law[INDEX[g[0]]] for g in self.groups])

    def write(self, law: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Laws with these values, shape (sets, len(LAW)); values of shape (sets, k)."""
        values = np.clip(np.atleast_2d(values), self.lower, self.upper)
        laws = np.tile(law, (len(values), 1))
        for i, group in enumerate(self.groups):
            for name in group:
                laws[:, INDEX[name]] = values[:, i]
        return laws


@dataclass(frozen=True, eq=False)
class Fitted:
    """A fitted law, its cost (mean Huber loss in robust scales), residuals [rad] and sensitivities (n, k)."""

    law: np.ndarray
    cost: float
    residual: np.ndarray
    jacobian: np.ndarray
    scale: float


def robust_scale(residual: np.ndarray, resolution: float) -> float:
    """Size of an ordinary residual [rad]: 1.48 times the median, not below the resolution of the encoder."""
    return max(1.4826 * float(np.median(np.abs(residual))), 2.0 * resolution)


def huber(residual: np.ndarray, scale: float) -> np.ndarray:
    """Huber's loss of each sample, in squared robust scales, shape as the residual's."""
    size = np.abs(residual) / scale
    return np.where(size < HUBER, 0.5 * size**2, HUBER * size - 0.5 * HUBER**2)


def sensitivities(data: JointData, coordinates: Coordinates, law: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Predicted positions (n,) and their derivatives by the coordinates in units of their sizes, (n, k)."""
    values = coordinates.read(law)
    signs = np.where(values + NUDGE * coordinates.sizes > coordinates.upper, -1.0, 1.0)
    moved = values + np.diag(signs * NUDGE * coordinates.sizes)
    found = data.predict(np.vstack([coordinates.write(law, values), coordinates.write(law, moved)]))
    return found[0], ((found[1:] - found[0]) / (signs[:, None] * NUDGE)).T


def fit_law(
    data: JointData,
    law: np.ndarray,
    coordinates: Coordinates,
    *,
    scale: float,
    iterations: int = 12,
    tolerance: float = 1e-3,
) -> Fitted:
    """The law that predicts a joint's motion best, from a start.

    Args:
        data: what is fitted; law: the start, shape (len(LAW),).
        coordinates: what is free.
        scale: robust scale of the residual [rad], held fixed.
        tolerance: relative gain of the cost below which it has converged.
    """
    law = coordinates.write(law, coordinates.read(law))[0]
    start = coordinates.read(law) / coordinates.sizes
    jacobian = np.zeros((len(data.series.q), 0))
    residual = data.errors(law)
    cost = float(np.mean(huber(residual, scale)))
    for _ in range(iterations if coordinates.groups else 0):
        predicted, jacobian = sensitivities(data, coordinates, law)
        values = coordinates.read(law) / coordinates.sizes
        steps = _steps(jacobian, predicted - data.series.q, scale, values - start, coordinates, values)
        laws = coordinates.write(law, (values + steps) * coordinates.sizes)
        costs = np.array([np.mean(huber(r, scale)) for r in data.predict(laws) - data.series.q])
        best = int(np.nanargmin(costs))
        if not costs[best] < cost:
            break
        gain, cost, law = cost - costs[best], float(costs[best]), laws[best]
        if gain < tolerance * cost:
            break
    return Fitted(law, cost, data.errors(law), jacobian, scale)


def _steps(
    jacobian: np.ndarray,
    residual: np.ndarray,
    scale: float,
    away: np.ndarray,
    coordinates: Coordinates,
    values: np.ndarray,
) -> np.ndarray:
    """Damped Gauss–Newton steps, shape (len(DAMPING), k), that leave out what a bound holds."""
    weight = 1.0 / np.maximum(1.0, np.abs(residual) / (HUBER * scale)) / scale**2 / len(residual)
    normal = (jacobian * weight[:, None]).T @ jacobian
    slope = jacobian.T @ (weight * residual) + PRIOR * away
    low, high = coordinates.lower / coordinates.sizes, coordinates.upper / coordinates.sizes
    held = ((values <= low) & (slope > 0.0)) | ((values >= high) & (slope < 0.0))
    normal[held], normal[:, held], slope[held] = 0.0, 0.0, 0.0
    diagonal = np.diag(normal) + PRIOR
    normal = normal + PRIOR * np.eye(len(values))
    return np.array([-np.linalg.solve(normal + d * np.diag(diagonal), slope) for d in DAMPING])


def free_coordinates(groups: Sequence[tuple[str, ...]], law: np.ndarray, sizes: dict[str, float]) -> Coordinates:
    """Coordinates of named groups, stepped in their present size or a typical one, whichever is larger."""
    unique = tuple(dict.fromkeys(groups))
    now = [max(abs(float(law[INDEX[g[0]]])), sizes[g[0]]) for g in unique]
    return Coordinates(unique, np.array(now))
