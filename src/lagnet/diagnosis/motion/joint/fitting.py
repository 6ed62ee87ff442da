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
DIFFERENCE = 2e-3  # step of a finite difference, in sizes of each parameter
COARSER = (5.0, 25.0)  # steps tried in a patient fit where the first finds no descent: sticking makes the cost rough
DAMPING = (1e-3, 1e-1, 1e1, 1e3)  # Levenberg–Marquardt factors, of which each iteration takes the best
PRIOR = 1e-4  # weight of |x − x₀|², per coordinate, so that an undetermined coordinate stays at the start


@dataclass(frozen=True, eq=False)
class JointData:
    """Data of one joint: its series, the windows of rollouts and the longest step of integration [s]."""

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
    """Free parameters of a law, each group with one value, and the sizes by which they are scaled."""

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
    """A fitted law.

    Args:
        law: shape (len(LAW),).
        cost: mean Huber loss in squared robust scales.
        residual: shape (n,), predicted less measured positions [rad].
        jacobian: shape (n, k), sensitivities ∂q̂/∂x.
        scale: robust scale of the residual [rad].
    """

    law: np.ndarray
    cost: float
    residual: np.ndarray
    jacobian: np.ndarray
    scale: float


def robust_scale(residual: np.ndarray, resolution: float) -> float:
    """max(1.4826 median |r|, 2 resolution), a robust standard deviation of the residual [rad]."""
    return max(1.4826 * float(np.median(np.abs(residual))), 2.0 * resolution)


def huber(residual: np.ndarray, scale: float) -> np.ndarray:
    """Huber's loss ρ(r/scale) of each sample, shape as the residual's."""
    size = np.abs(residual) / scale
    return np.where(size < HUBER, 0.5 * size**2, HUBER * size - 0.5 * HUBER**2)


def sensitivities(
    data: JointData, coordinates: Coordinates, law: np.ndarray, predicted: np.ndarray, difference: float = DIFFERENCE
) -> np.ndarray:
    """∂q̂/∂x by the coordinates in units of their sizes, shape (n, k); predicted: q̂ of the law, shape (n,)."""
    values = coordinates.read(law)
    signs = np.where(values + difference * coordinates.sizes > coordinates.upper, -1.0, 1.0)
    moved = values + np.diag(signs * difference * coordinates.sizes)
    found = data.predict(coordinates.write(law, moved))
    return ((found - predicted) / (signs[:, None] * difference)).T


def fit_law(
    data: JointData,
    law: np.ndarray,
    coordinates: Coordinates,
    *,
    scale: float,
    iterations: int = 12,
    tolerance: float = 1e-3,
    patient: bool = False,
) -> Fitted:
    """argmin of the mean Huber loss of a joint's rollouts, from a start.

    Args:
        data: windows that are fitted.
        law: the start, shape (len(LAW),).
        coordinates: parameters that are free.
        scale: robust scale of the residual [rad], held fixed.
        iterations: at most.
        tolerance: relative gain of the cost at which it has converged.
        patient: try coarser differences where the cost does not fall.
    """
    law = coordinates.write(law, coordinates.read(law))[0]
    start = coordinates.read(law) / coordinates.sizes
    jacobian = np.zeros((len(data.series.q), 0))
    measured, predicted = data.series.q, data.predict(law)[0]
    cost = float(np.mean(huber(predicted - measured, scale)))
    differences = [DIFFERENCE, *(DIFFERENCE * c for c in COARSER if patient)]
    for _ in range(iterations if coordinates.groups else 0):
        jacobian = sensitivities(data, coordinates, law, predicted, differences[0])
        values = coordinates.read(law) / coordinates.sizes
        steps = _steps(jacobian, predicted - measured, scale, values - start, coordinates, values)
        laws = coordinates.write(law, (values + steps) * coordinates.sizes)
        tried = data.predict(laws)
        costs = np.array([np.mean(huber(r, scale)) for r in tried - measured])
        best = int(np.nanargmin(costs))
        gain = cost - float(costs[best])
        if gain > 0.0:
            cost, law, predicted = float(costs[best]), laws[best], tried[best]
        if not gain > tolerance * cost:
            differences = differences[1:]
        if not differences:
            break
    return Fitted(law, cost, predicted - measured, jacobian, scale)


def _steps(
    jacobian: np.ndarray,
    residual: np.ndarray,
    scale: float,
    away: np.ndarray,
    coordinates: Coordinates,
    values: np.ndarray,
) -> np.ndarray:
    """−(JᵀWJ + λ diag)⁻¹ ∇, shape (len(DAMPING), k), with coordinates at an active bound fixed."""
    weight = 1.0 / np.maximum(1.0, np.abs(residual) / (HUBER * scale)) / scale**2 / len(residual)
    normal = (jacobian * weight[:, None]).T @ jacobian
    gradient = jacobian.T @ (weight * residual) + PRIOR * away
    low, high = coordinates.lower / coordinates.sizes, coordinates.upper / coordinates.sizes
    active = ((values <= low) & (gradient > 0.0)) | ((values >= high) & (gradient < 0.0))
    normal[active], normal[:, active], gradient[active] = 0.0, 0.0, 0.0
    diagonal = np.diag(normal) + PRIOR
    normal = normal + PRIOR * np.eye(len(values))
    return np.array([-np.linalg.solve(normal + d * np.diag(diagonal), gradient) for d in DAMPING])


def free_coordinates(groups: Sequence[tuple[str, ...]], law: np.ndarray, sizes: dict[str, float]) -> Coordinates:
    """Coordinates of parameter groups, scaled by their present value or a typical one, whichever is larger."""
    unique = tuple(dict.fromkeys(groups))
    sizes_of_groups = [max(abs(float(law[INDEX[g[0]]])), sizes[g[0]]) for g in unique]
    return Coordinates(unique, np.array(sizes_of_groups))
