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

from lagnet.models.serial_chain.identification.separable import EMPTY, Samples, evaluate_at
from lagnet.models.serial_chain.identification.unknowns import Unknowns
from lagnet.models.serial_chain.mechanics.inertia import from_standard, to_standard
from lagnet.models.serial_chain.mechanics.joint_terms import DISSIPATIVE_OR_MASSIVE
from lagnet.rigid_body.consistent_fit import fit_consistent
from lagnet.rigid_body.inertia import (
    from_log_cholesky,
    is_physically_consistent,
    log_cholesky_jacobian,
    parameters_of_body,
    to_log_cholesky,
)

# linear(u) -> the linear unknowns and their derivative by u
Coordinates = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]

SETTLED = 1e-6  # relative gain of a step after which there are no more: far below what noise changes
EXACT = 1e-28  # share of the weighted torque at which only rounding is left
FAINT = 1e-6  # weight of the prior over bodies, as a share of the residual's cost: settles only what torque does not
GIVE = 1e-6  # damping of the shape and joint terms beside the links, relative
LINEARISATIONS = 4
LONGEST = 1.0  # step of a log-Cholesky coordinate or a log coefficient: a factor e
MARGIN = 1e-12  # smallest eigenvalue of a scaled pseudo-inertia that a Cholesky factor survives
SMALLEST = 1e-6  # where an exponential coefficient starts from if the free fit makes it negative [SI]


class Sums(NamedTuple):
    """What a step needs, over all samples.

    Args:
        cost: sum of squared weighted residuals r.
        gram: DᵀD for the derivative D of the torque by linear unknowns, then shape.
        pull: Dᵀr.
    """

    cost: float
    gram: np.ndarray
    pull: np.ndarray


class Refitted(NamedTuple):
    """Constants of an arm and what they leave.

    Args:
        x: shape; w: moments and joint terms; sums: at these constants.
    """

    x: np.ndarray
    w: np.ndarray
    sums: Sums


class Refit:
    """Compiled sums over one set of samples, whose weights may change between refits."""

    def __init__(self, unknowns: Unknowns):
        self.unknowns = unknowns
        self._penalty = jax.jit(lambda x: (unknowns.reach(x), jax.jacfwd(unknowns.reach)(x)))
        self._evaluate = jax.jit(lambda samples, x, w: evaluate_at(unknowns.full_design, samples, x, w))

    def free(self, samples: Samples, x: np.ndarray, w: np.ndarray, iterations: int = 40) -> Refitted:
        """Refit with nothing held: links may come out with negative mass where torque does not tell."""
        return self._descend(samples, x, w, lambda u: (u, np.eye(u.size)), iterations, np.inf)

    def physical(self, samples: Samples, start: Refitted, iterations: int = 15) -> Refitted:
        """Refit with links that can exist and joint terms that dissipate."""
        links = 10 * self.unknowns.n_dof
        positive = _positive_terms(self.unknowns)
        found = self._convex(samples, start, links, positive)
        terms = found.w[links:].copy()
        terms[positive] = np.log(terms[positive])
        u = np.concatenate([*(to_log_cholesky(body) for body in to_standard(found.w[:links].reshape(-1, 10))), terms])
        return self._descend(samples, found.x, u, lambda u: _physical(u, links, positive), iterations, LONGEST)

    def _convex(self, samples: Samples, start: Refitted, links: int, positive: np.ndarray) -> Refitted:
        """Best links that can exist for the torque linearised in the shape: convex, solved anew a few times."""
        best, current = None, start
        for _ in range(LINEARISATIONS):
            w, x = _nearest_bodies(current, links, positive, self.unknowns.scale)
            tried = Refitted(x, w, self._sums(samples, x, w))
            if best is not None and not tried.sums.cost < (1 - FAINT) * best.sums.cost:
                break
            best = current = tried
        assert best is not None
        return best

    def _descend(
        self, samples: Samples, x: np.ndarray, u: np.ndarray, linear: Coordinates, iterations: int, longest: float
    ) -> Refitted:
        """Levenberg–Marquardt in x and u together."""
        w, slope = linear(u)
        limit = np.concatenate([np.full(u.size, longest), self.unknowns.scale])
        sums = self._sums(samples, x, w)
        weight = sums.cost / float(jnp.sum(samples.weight > 0))
        exact = EXACT * float(jnp.sum((samples.tau * samples.weight) ** 2))
        with_penalty = self._penalised(sums, x, weight)
        damping, gain = 1e-6, np.inf
        for _ in range(iterations):
            if sums.cost < exact or damping > 1e5 or gain < SETTLED * sums.cost:
                break
            step, damping = _damped_step(with_penalty, slope, limit, damping)
            u_new, x_new = u + step[: u.size], x + step[u.size :]
            w_new, slope_new = linear(u_new)
            tried = self._sums(samples, x_new, w_new)
            tried_with = self._penalised(tried, x_new, weight)
            if not tried_with.cost < with_penalty.cost:
                damping = 30.0 * max(damping, 1e-6)
                continue
            gain = with_penalty.cost - tried_with.cost
            x, u, w, slope, sums, with_penalty = x_new, u_new, w_new, slope_new, tried, tried_with
            damping = max(0.1 * damping, 1e-12)
        return Refitted(x, w, sums)

    def _penalised(self, sums: Sums, x: np.ndarray, weight: float) -> Sums:
        """The same sums with the penalty on long links, in the proportions of one torque's noise."""
        thought, lean = map(np.asarray, self._penalty(jnp.asarray(x)))
        gram, pull = sums.gram.copy(), sums.pull.copy()
        gram[-x.size :, -x.size :] += weight * lean.T @ lean
        pull[-x.size :] -= weight * lean.T @ thought
        return Sums(sums.cost + weight * float(thought @ thought), gram, pull)

    def _sums(self, samples: Samples, x: np.ndarray, w: np.ndarray) -> Sums:
        sums = self._evaluate(samples, jnp.asarray(x), jnp.asarray(w))
        both = np.block([[sums.linear, sums.cross], [sums.cross.T, sums.curvature]])
        return Sums(float(sums.cost), both, np.concatenate([sums.pull, sums.slope]))


def _damped_step(sums: Sums, slope: np.ndarray, limit: np.ndarray, damping: float) -> tuple[np.ndarray, float]:
    """Step in (u, x), unknowns scaled to unit effect, damped until none goes beyond its limit; and the damping."""
    change = np.asarray(block_diag(slope, np.eye(limit.size - slope.shape[1])))
    matrix, pull = change.T @ sums.gram @ change, change.T @ sums.pull
    size = np.sqrt(np.maximum(np.diag(matrix), 0.0))
    size = np.where(size > EMPTY * size.max(), size, np.inf)
    matrix = matrix / np.outer(size, size)
    while True:
        np.fill_diagonal(matrix, 1.0 + damping + 1e-12)
        step = cho_solve(cho_factor(matrix), pull / size) / size
        if np.max(np.abs(step) / limit, initial=0.0) < 0.5 or damping > 1e6:
            return step, damping
        damping *= 4.0


def _physical(u: np.ndarray, links: int, positive: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Linear unknowns of log-Cholesky coordinates and log coefficients, with their derivative."""
    bodies = u[:links].reshape(-1, 10)
    moments = [from_standard(from_log_cholesky(body)) for body in bodies]
    slopes = [from_standard(log_cholesky_jacobian(body).T).T for body in bodies]
    terms = np.where(positive, np.exp(np.where(positive, u[links:], 0.0)), u[links:])
    slopes.append(np.diag(np.where(positive, terms, 1.0)))
    return np.concatenate([*moments, terms]), np.asarray(block_diag(*slopes))


def _positive_terms(unknowns: Unknowns) -> np.ndarray:
    positive = [name in DISSIPATIVE_OR_MASSIVE for name in unknowns.joint_terms]
    return np.repeat(np.array(positive, dtype=bool), unknowns.n_dof)


def _nearest_bodies(
    start: Refitted, links: int, positive: np.ndarray, scale: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Linear unknowns with links that can exist, and shape, that change the torque least; the others give way."""
    gram, pull = start.sums.gram, start.sums.pull
    rest = gram[links:, links:] + np.diag(GIVE * np.diag(gram)[links:] + np.finfo(float).tiny)
    cross = gram[:links, links:]
    give = np.linalg.lstsq(rest, np.column_stack([cross.T, pull[links:]]), rcond=1e-14)[0]
    reduced = gram[:links, :links] - cross @ give[:, :-1]
    moment = reduced @ start.w[:links] + pull[:links] - cross @ give[:, -1]
    to_moments = np.asarray(block_diag(*([from_standard(np.eye(10)).T] * (links // 10))))
    prior = np.tile(_ordinary_body(start, links), (links // 10, 1))
    weight = FAINT * start.sums.cost + FAINT**2 * float(abs(moment @ start.w[:links]))
    bodies = fit_consistent(to_moments.T @ reduced @ to_moments, to_moments.T @ moment, prior, weight)
    moments = from_standard(_inside(bodies, prior)).ravel()
    change = give[:, -1] - give[:, :-1] @ (moments - start.w[:links])
    terms = start.w[links:] + change[: positive.size]
    terms[positive] = np.maximum(terms[positive], SMALLEST)
    step = change[positive.size :]
    step = step * min(1.0, 0.2 / np.max(np.abs(step) / scale, initial=1e-300))
    return np.concatenate([moments, terms]), start.x + step


def _inside(bodies: np.ndarray, prior: np.ndarray) -> np.ndarray:
    """The same bodies, moved towards the prior by the little that puts them off the edge where rounding left them."""
    share = 1e-12
    while not np.all(is_physically_consistent(bodies, MARGIN)):
        bodies, share = (1 - share) * bodies + share * prior, 10.0 * share
    return bodies


def _ordinary_body(start: Refitted, links: int) -> np.ndarray:
    """A round body of the size that the free fit suggests, for what torque does not tell."""
    free = to_standard(start.w[:links].reshape(-1, 10))
    inertia = max(float(np.median(np.abs(free[:, [4, 6, 9]]))), 1e-6)
    mass = max(float(np.median(np.abs(free[:, 0]))), 10.0 * inertia)
    return parameters_of_body(mass, np.zeros(3), inertia * np.eye(3))
