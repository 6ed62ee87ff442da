"""argmin over a few numbers of the motion of all joints: Levenberg–Marquardt over rollouts of the whole arm.

The cost is the sum over joints of the mean Huber loss in robust scales, so that a joint of small errors counts as much
as one of large ones and a contact that nothing explains bends no value.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from lagnet.diagnosis.motion.joint.fitting import DAMPING, HUBER, PRIOR, huber, robust_scale

DIFFERENCE = 5e-3  # step of a finite difference, in sizes of the values
CONVERGED = 1e-3  # relative gain of the cost
ROUNDS = 2

Errors = Callable[[np.ndarray], list[np.ndarray]]  # values → predicted less measured positions of each joint [rad]
Sensitivities = Callable[[np.ndarray, list[np.ndarray]], list[np.ndarray]]  # values, errors → ∂q̂/∂x of each joint


def sensitivities_of(
    errors: Errors, sizes: np.ndarray, nearest: Callable[[np.ndarray], np.ndarray] = np.asarray
) -> Sensitivities:
    """∂q̂/∂x of every joint by every value in units of the sizes, each of shape (n, k), one rollout each value.

    Args:
        errors: of the joints as a function of the values.
        sizes: shape (k,).
        nearest: the nearest possible values; at a bound the difference is taken inwards.
    """

    def sensitivities(values: np.ndarray, here: list[np.ndarray]) -> list[np.ndarray]:
        columns = []
        for row in np.diag(DIFFERENCE * sizes):
            step = row if np.all(nearest(values + row) >= values + row) else -row
            side = np.sign(step.sum()) * DIFFERENCE
            columns.append([(m - e) / side for m, e in zip(errors(values + step), here, strict=True)])
        return [np.column_stack([c[i] for c in columns]) for i in range(len(here))]

    return sensitivities


def cost_of(errors: list[np.ndarray], scales: np.ndarray) -> float:
    """Sum over joints of the mean Huber loss; infinite for a rollout that diverged."""
    found = sum(float(np.mean(huber(e, s))) for e, s in zip(errors, scales, strict=True))
    return found if np.isfinite(found) else np.inf


def robust_scales(errors: Sequence[np.ndarray], floors: np.ndarray) -> np.ndarray:
    """Robust scale of every joint's errors, at least its floor, shape (joints,)."""
    return np.array([robust_scale(e, f) for e, f in zip(errors, floors, strict=True)])


def fit_values(
    errors: Errors,
    sensitivities: Sensitivities,
    start: np.ndarray,
    sizes: np.ndarray,
    floors: np.ndarray,
    *,
    nearest: Callable[[np.ndarray], np.ndarray] = np.asarray,
    iterations: int = 20,
    rounds: int = ROUNDS,
) -> np.ndarray:
    """The values of least cost from a start, shape (k,).

    Args:
        errors: of the joints as a function of the values.
        sensitivities: ∂q̂/∂x of each joint in units of the sizes, each of shape (n, k).
        start, sizes: shape (k,).
        floors: shape (joints,), resolution of the errors [rad].
        nearest: the nearest possible values.
        iterations: at most, in each round.
        rounds: fits, each with the robust scale of the one before.
    """
    values = nearest(start)
    for _ in range(rounds):
        scales = robust_scales(errors(values), floors)
        values = _fitted(errors, sensitivities, values, sizes, scales, nearest, iterations)
    return values


def _fitted(
    errors: Errors,
    sensitivities: Sensitivities,
    values: np.ndarray,
    sizes: np.ndarray,
    scales: np.ndarray,
    nearest: Callable[[np.ndarray], np.ndarray],
    iterations: int,
) -> np.ndarray:
    first, here = values / sizes, errors(values)
    cost = cost_of(here, scales)
    for _ in range(iterations):
        normal, gradient = PRIOR * np.eye(len(values)), PRIOR * (values / sizes - first)
        for e, jacobian, s in zip(here, sensitivities(values, here), scales, strict=True):
            weight = 1.0 / np.maximum(1.0, np.abs(e) / (HUBER * s)) / s**2 / len(e)
            normal = normal + (jacobian * weight[:, None]).T @ jacobian
            gradient = gradient + jacobian.T @ (weight * e)
        steps = [-np.linalg.solve(normal + d * np.diag(np.diag(normal)), gradient) for d in DAMPING]
        tried = [(x, errors(x)) for x in (nearest(values + step * sizes) for step in steps)]
        costs = [cost_of(e, scales) for _, e in tried]
        best = int(np.argmin(costs))
        gain = cost - costs[best]
        if gain > 0.0:
            cost, (values, here) = costs[best], tried[best]
        if not gain > CONVERGED * cost:
            break
    return values
