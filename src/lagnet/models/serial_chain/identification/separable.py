"""Least squares in which most unknowns are linear: eliminate those, and step in the few that are not.

Torque is P(x) w. For each x the best w solves linear normal equations; Levenberg–Marquardt then moves x with the part
of the derivative of P(x) w that no change of w could make up (variable projection, Kaufman's form). Sums run over
chunks of samples, so that ten thousand samples need no more memory than five hundred, and many starts run at once
(vmap). Source: Golub & Pereyra 1973; Kaufman 1975; Marquardt 1963.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax.scipy.linalg import cho_factor, cho_solve
from jaxtyping import Array

# penalty(x) -> residuals of what is thought of x beforehand, each as sure as one torque
Penalty = Callable[[Array], Array]

# design(x, q, v, a) -> (dof, number of linear unknowns) for one sample
Design = Callable[[Array, Array, Array, Array], Array]

RIDGE = (
    1e-10  # of the scaled normal matrix: holds undetermined unknowns near zero, moves determined ones by about as much
)
EMPTY = 1e-11  # of the largest column: what is smaller is a column of rounding errors, and its unknown stays zero
LARGEST_STEP = 0.7  # in units of the scale of x: beyond this an angle's derivative says little


class Samples(NamedTuple):
    """Motion and torque in equal chunks, shape (chunks, size, dof); `weight` is 1 / noise, and 0 for padding."""

    q: Array
    v: Array
    a: Array
    tau: Array
    weight: Array


class Normal(NamedTuple):
    """Everything a step needs: sums over samples at one x and its best w.

    Args:
        w: linear unknowns; cost: sum of squared weighted residuals.
        linear: PᵀP; cross: PᵀJ; curvature: JᵀJ; pull: Pᵀr; slope: Jᵀr, with J = ∂(P w)/∂x and r the residual.
    """

    w: Array
    cost: Array
    linear: Array
    cross: Array
    curvature: Array
    pull: Array
    slope: Array


class Point(NamedTuple):
    """Where a start has got to: x, its damping, its sums, and its cost with the penalty."""

    x: Array
    damping: Array
    normal: Normal
    total: Array


def make_samples(
    q: np.ndarray, v: np.ndarray, a: np.ndarray, tau: np.ndarray, noise: np.ndarray, size: int = 500
) -> Samples:
    """Cut samples (n, dof) into chunks and weigh each joint by 1 / noise (dof,)."""
    n, dof = q.shape
    size = min(size, n)
    chunks = -(-n // size)
    weight = np.zeros((chunks * size, dof))
    weight[:n] = 1.0 / noise
    pad = [(0, chunks * size - n), (0, 0)]
    parts = [np.pad(x, pad) for x in (q, v, a, tau)] + [weight]
    return Samples(*(jnp.asarray(part.reshape(chunks, size, dof)) for part in parts))


def solve_linear(matrix: Array, right: Array) -> Array:
    """Solve normal equations after scaling each unknown to unit size, with a trace of ridge."""
    scale = jnp.sqrt(jnp.diag(matrix))
    scale = jnp.where(scale > EMPTY * jnp.max(scale), scale, jnp.inf)
    scaled = matrix / jnp.outer(scale, scale) + RIDGE * jnp.eye(scale.size)
    divide = scale if right.ndim == 1 else scale[:, None]
    return cho_solve(cho_factor(scaled), right / divide) / divide


def evaluate(design: Design, samples: Samples, x: Array) -> Normal:
    """Best linear unknowns at x, and the sums of one step."""
    matrix, right = _sum_linear(design, samples, x)
    return evaluate_at(design, samples, x, solve_linear(matrix, right))


def evaluate_at(design: Design, samples: Samples, x: Array, w: Array) -> Normal:
    """The sums of one step at given linear unknowns."""
    directions = jnp.eye(x.size)

    def add(total, part):
        q, v, a, tau, weight = part

        def torque(x):
            return jax.vmap(lambda *s: design(x, *s) @ w)(q, v, a) * weight

        columns = _weighted(design, x, part)
        slope = jax.vmap(lambda d: jax.jvp(torque, (x,), (d,))[1].reshape(-1), out_axes=1)(directions)
        residual = (tau * weight).reshape(-1) - columns @ w
        both = jnp.concatenate([columns, slope], axis=1)
        new = (both.T @ both, both.T @ residual, residual @ residual)
        return jax.tree.map(jnp.add, total, new), None

    size = w.size + x.size
    zero = (jnp.zeros((size, size)), jnp.zeros(size), jnp.zeros(()))
    (gram, pull, cost), _ = jax.lax.scan(add, zero, samples)
    m = w.size
    return Normal(w, cost, gram[:m, :m], gram[:m, m:], gram[m:, m:], pull[:m], pull[m:])


def _sum_linear(design: Design, samples: Samples, x: Array) -> tuple[Array, Array]:
    def add(total, part):
        columns = _weighted(design, x, part)
        return (total[0] + columns.T @ columns, total[1] + columns.T @ (part.tau * part.weight).reshape(-1)), None

    m = jax.eval_shape(design, x, samples.q[0, 0], samples.v[0, 0], samples.a[0, 0]).shape[1]
    return jax.lax.scan(add, (jnp.zeros((m, m)), jnp.zeros(m)), samples)[0]


def _weighted(design: Design, x: Array, part: Samples) -> Array:
    columns = jax.vmap(lambda *s: design(x, *s))(part.q, part.v, part.a) * part.weight[..., None]
    return columns.reshape(-1, columns.shape[-1])


def no_penalty(x: Array) -> Array:
    """Nothing is thought of x beforehand."""
    return jnp.zeros(1)


def _step(design: Design, penalty: Penalty, samples: Samples, scale: Array, point: Point) -> Point:
    """One damped step, taken back where it does not lower the cost.

    The penalty multiplies the cost, so that it weighs as the noise does and vanishes where torque is explained exactly.
    """
    normal, count = point.normal, jnp.sum(samples.weight > 0)
    thought, lean = penalty(point.x), jax.jacfwd(penalty)(point.x)
    share = jnp.where(jnp.isfinite(normal.cost), normal.cost, 0.0) / count
    reduced = normal.curvature - normal.cross.T @ solve_linear(normal.linear, normal.cross)
    reduced = (reduced + share * lean.T @ lean) * jnp.outer(scale, scale)
    floor = 1e-7 * jnp.trace(reduced) / scale.size
    damped = reduced + jnp.diag(point.damping * (jnp.diag(reduced) + floor) + 1e-6 * floor + 1e-30)
    step = jnp.linalg.solve(damped, (normal.slope - share * lean.T @ thought) * scale)
    step = step * jnp.minimum(1.0, LARGEST_STEP / (jnp.max(jnp.abs(step)) + 1e-300))
    x = point.x + step * scale
    tried = evaluate(design, samples, x)
    total = tried.cost * (1.0 + jnp.sum(penalty(x) ** 2) / count)
    better = total < point.total
    damping = jnp.clip(jnp.where(better, 0.2 * point.damping, 5.0 * point.damping), 1e-9, 1e9)
    taken = jax.tree.map(partial(jnp.where, better), (x, tried, total), (point.x, normal, point.total))
    return Point(taken[0], damping, taken[1], taken[2])


def _unvisited(x: Array, linear: int) -> Point:
    """A start before its first sums: the first step stays at x and takes them, so that one compiled step does both."""
    m, k = linear, x.size
    normal = Normal(
        jnp.zeros(m),
        jnp.full((), jnp.inf),
        jnp.zeros((m, m)),
        jnp.zeros((m, k)),
        jnp.zeros((k, k)),
        jnp.zeros(m),
        jnp.zeros(k),
    )
    return Point(x, jnp.full((), 0.5), normal, jnp.full((), jnp.inf))


class Descent:
    """Compiled steps for one design and one set of samples, shared by all batches of starts."""

    def __init__(self, design: Design, samples: Samples, scale: np.ndarray, penalty: Penalty = no_penalty):
        self._step = jax.jit(jax.vmap(lambda p, s: _step(design, penalty, s, jnp.asarray(scale), p), (0, None)))
        self._samples = samples
        self.energy = float(jnp.sum((samples.tau * samples.weight) ** 2))
        self._linear = jax.eval_shape(
            design, jnp.asarray(scale), samples.q[0, 0], samples.v[0, 0], samples.a[0, 0]
        ).shape[1]

    def run(self, starts: np.ndarray, iterations: int, target: float) -> Point:
        """Descend from every row of `starts` until none moves, or one explains all but `target` of the torque."""
        point = jax.vmap(lambda x: _unvisited(x, self._linear))(jnp.asarray(starts))
        costs = []
        for count in range(iterations + 1):
            point = self._step(point, self._samples)
            costs.append(np.asarray(point.normal.cost))
            settled = count > 8 and np.all(costs[-5] - costs[-1] < 1e-4 * costs[-5])
            if settled or costs[-1].min() < target * self.energy:
                break
        return point
