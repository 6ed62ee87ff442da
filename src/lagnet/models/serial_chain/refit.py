"""The last steps of a fit, on all samples and in all unknowns at once; with links free, or such as can exist.

Free: shape, moments and joint terms as they are. Physical: each link in log-Cholesky coordinates, which make its
pseudo-inertia positive definite whatever their values, and each friction or rotor coefficient as an exponential. The
physical refit starts from the convex problem of the links alone. Source: Rucker & Wensing 2022; Marquardt 1963.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from scipy.linalg import block_diag, cho_factor, cho_solve

from lagnet.models.serial_chain.inertia import from_standard, to_standard
from lagnet.models.serial_chain.joint_terms import DISSIPATIVE_OR_MASSIVE
from lagnet.models.serial_chain.separable import Normal, Samples, evaluate_at
from lagnet.models.serial_chain.unknowns import Unknowns
from lagnet.rigid_body.consistent_fit import fit_consistent
from lagnet.rigid_body.inertia import from_log_cholesky, log_cholesky_jacobian, parameters_of_body, to_log_cholesky

# linear(u) -> the linear unknowns and their derivative by u
Coordinates = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]

SMALLEST = 1e-6  # where an exponential coefficient starts from if the free fit makes it negative [SI]


class Refitted(NamedTuple):
    """Constants of an arm and what they leave.

    Args:
        x: shape; w: moments and joint terms; cost: sum of squared weighted residuals; normal: the sums at the end.
    """

    x: np.ndarray
    w: np.ndarray
    cost: float
    normal: Normal


class Refit:
    """Compiled sums over one set of samples, whose weights may change between refits."""

    def __init__(self, unknowns: Unknowns):
        self.unknowns = unknowns
        self._evaluate = jax.jit(lambda samples, x, w: evaluate_at(unknowns.full_design, samples, x, w))

    def free(self, samples: Samples, x: np.ndarray, w: np.ndarray, iterations: int = 40) -> Refitted:
        """Refit with nothing held: links may come out with negative mass where torque does not tell."""
        return self._descend(samples, x, w, lambda u: (u, np.eye(u.size)), iterations)

    def physical(self, samples: Samples, start: Refitted, iterations: int = 60) -> Refitted:
        """Refit with links that can exist and joint terms that dissipate."""
        links = 10 * self.unknowns.n_dof
        bodies = _nearest_bodies(start, links)
        positive = _positive_terms(self.unknowns)
        terms = start.w[links:].copy()
        terms[positive] = np.log(np.maximum(terms[positive], SMALLEST))
        u = np.concatenate([*(to_log_cholesky(body) for body in bodies), terms])
        return self._descend(samples, start.x, u, lambda u: _physical(u, links, positive), iterations)

    def _descend(
        self, samples: Samples, x: np.ndarray, u: np.ndarray, linear: Coordinates, iterations: int
    ) -> Refitted:
        """Levenberg–Marquardt in x and u together."""
        scale = self.unknowns.scale
        w, slope = linear(u)
        normal = self._numbers(samples, x, w)
        damping, k = 1e-3, x.size
        for _ in range(iterations):
            step = _damped_step(normal, slope, scale, damping)
            x_new, u_new = x + step[:k], u + step[k:]
            w_new, slope_new = linear(u_new)
            tried = self._numbers(samples, x_new, w_new)
            gain = float(normal.cost - tried.cost)
            if not gain > 0:
                damping *= 10.0
                if damping > 1e8:
                    break
                continue
            done = gain < 1e-10 * float(normal.cost)
            x, u, w, slope, normal = x_new, u_new, w_new, slope_new, tried
            damping = max(0.1 * damping, 1e-12)
            if done:
                break
        return Refitted(x, w, float(normal.cost), normal)

    def _numbers(self, samples: Samples, x: np.ndarray, w: np.ndarray) -> Normal:
        return Normal(*map(np.asarray, self._evaluate(samples, jnp.asarray(x), jnp.asarray(w))))


def _damped_step(normal: Normal, slope: np.ndarray, scale: np.ndarray, damping: float) -> np.ndarray:
    """Step in (x, u) with every unknown scaled to unit effect; those without effect stay."""
    cross = normal.cross.T @ slope
    matrix = np.block([[normal.curvature, cross], [cross.T, slope.T @ normal.linear @ slope]])
    pull = np.concatenate([normal.slope, slope.T @ normal.pull])
    size = np.sqrt(np.maximum(np.diag(matrix), 0.0))
    size = np.where(size > 1e-12 * size.max(), size, np.inf)
    matrix = matrix / np.outer(size, size)
    np.fill_diagonal(matrix, 1.0 + damping + 1e-12)
    step = cho_solve(cho_factor(matrix), pull / size) / size
    largest = np.max(np.abs(step[: scale.size]) / scale, initial=1e-300)
    return step * min(1.0, 0.5 / largest)


def _physical(u: np.ndarray, links: int, positive: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Linear unknowns of log-Cholesky coordinates and log coefficients, with their derivative."""
    bodies = u[:links].reshape(-1, 10)
    moments = [from_standard(from_log_cholesky(body)) for body in bodies]
    slopes = [from_standard(log_cholesky_jacobian(body).T).T for body in bodies]
    terms = np.where(positive, np.exp(np.where(positive, u[links:], 0.0)), u[links:])
    slopes.append(np.diag(np.where(positive, terms, 1.0)))
    return np.concatenate([*moments, terms]), block_diag(*slopes)


def _positive_terms(unknowns: Unknowns) -> np.ndarray:
    positive = [name in DISSIPATIVE_OR_MASSIVE for name in unknowns.joint_terms]
    return np.repeat(np.array(positive, dtype=bool), unknowns.n_dof)


def _nearest_bodies(start: Refitted, links: int) -> np.ndarray:
    """Links that can exist and change the torque least, at the shape found; joint terms are free to give way."""
    gram, moment = start.normal.linear, start.normal.linear @ start.w + start.normal.pull
    terms = slice(links, None)
    give = np.linalg.lstsq(gram[terms, terms], np.column_stack([gram[terms, :links], moment[terms]]), rcond=1e-12)[0]
    reduced = gram[:links, :links] - gram[:links, terms] @ give[:, :-1]
    reduced_moment = moment[:links] - gram[:links, terms] @ give[:, -1]
    to_moments = block_diag(*([from_standard(np.eye(10)).T] * (links // 10)))
    prior = np.tile(_ordinary_body(start, links), (links // 10, 1))
    return fit_consistent(to_moments.T @ reduced @ to_moments, to_moments.T @ reduced_moment, prior)


def _ordinary_body(start: Refitted, links: int) -> np.ndarray:
    """A round body of the size that the free fit suggests, for what torque does not tell."""
    free = to_standard(start.w[:links].reshape(-1, 10))
    inertia = max(float(np.median(np.abs(free[:, [4, 6, 9]]))), 1e-6)
    mass = max(float(np.median(np.abs(free[:, 0]))), 10.0 * inertia)
    return parameters_of_body(mass, np.zeros(3), inertia * np.eye(3))
