"""argmax p(x | α, σ²) with α, σ² at the maximum of the evidence: ridge regression of all joints together.

With unknowns x ~ N(0, 1/α_g) and errors of joint j ~ N(0, s σ_j²), the fixed point of MacKay 1992 sets α_g to
γ_g / |x_g|², γ_g the number of unknowns that the data determine, and σ_j² to the mean squared error. The statistical
inefficiency s accounts for errors of filtered motion, which are correlated: s samples have the information of one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import get_lapack_funcs

from lagnet.diagnosis.identified.design import Design
from lagnet.diagnosis.identified.equations import LEAST_ERROR, JointEquations

STEPS = 30  # of the fixed point
LEAST_PRECISION, MOST_PRECISION = 1e-6, 1e8  # α: columns are in parts of the joint's torque
FREE = 0.1  # α of free unknowns, fixed: torque up to some three times that of the joint
START = 1e-4  # initial α
EXCLUDED = 1e14  # α of unknowns that are not fitted
ROUNDING = 1e-10  # of the mean diagonal
LEAST_NOISE = 1e-150  # [N² m²] of a joint without torque, whose reciprocal is still a number

factored, inverted, solved = get_lapack_funcs(("potrf", "potri", "potrs"), dtype=np.float64)


@dataclass(frozen=True, eq=False)
class Ridge:
    """Posterior mean and covariance of the unknowns.

    Args:
        x: shape (n_unknowns,), scaled unknowns.
        covariance: shape (n_unknowns, n_unknowns).
        variance: shape (dof,), σ_j² of each joint [N² m²].
        precision: shape (n_unknowns,), α of each unknown.
    """

    x: np.ndarray
    covariance: np.ndarray
    variance: np.ndarray
    precision: np.ndarray


def fit_ridge(
    design: Design,
    sums: Sequence[JointEquations],
    inefficiency: float,
    start: Ridge | None = None,
    steps: int = STEPS,
    excluded: frozenset[int] = frozenset(),
) -> Ridge:
    """The fixed point of x, α and σ².

    Args:
        design: the equations.
        sums: normal equations of each joint.
        inefficiency: s, samples with the information of one.
        start: a fit whose α and σ² are the initial ones.
        steps: of the fixed point.
        excluded: indices of groups that are fixed at zero.
    """
    system = _stacked(design, sums, excluded)
    groups = _fitted_groups(design, system.fitted)
    n_samples = np.array([max(s.n_samples, 1.0) for s in sums])
    power = np.maximum(system.power, 1e-300) / n_samples
    variance = 0.1 * power if start is None else start.variance
    precision = np.full(system.fitted.size, START)
    if start is not None:
        precision = np.minimum(start.precision[system.fitted], MOST_PRECISION)
    for _ in range(steps):
        x, lower = _solve(system, precision, inefficiency * variance)
        precision = _precisions(groups, x, np.diag(lower), precision)
        variance = np.maximum(system.errors(x) / n_samples, LEAST_ERROR * power)
    x, lower = _solve(system, precision, inefficiency * variance)
    return _over_all(design.n_unknowns, system.fitted, Ridge(x, lower, variance, precision))


def solve_beside(design: Design, sums: Sequence[JointEquations], inefficiency: float, beside: Ridge) -> np.ndarray:
    """Posterior mean of x, shape (n_unknowns,), for the α and σ² of a fit to other rows.

    Args:
        design: the equations.
        sums: normal equations of each joint.
        inefficiency: s, samples with the information of one.
        beside: the fit; what it excludes is zero.
    """
    n, fitted = design.n_unknowns, np.flatnonzero(beside.precision < EXCLUDED)
    x, gram, moment = np.zeros(n), np.zeros((n, n)), np.zeros(n)
    if not fitted.size:
        return x
    for s, joint, weight in zip(sums, design.joints, _weights(inefficiency * beside.variance), strict=True):
        gram[np.ix_(joint.unknowns, joint.unknowns)] += weight * s.gram
        moment[joint.unknowns] += weight * s.moment
    x[fitted] = solved(_factor(gram[np.ix_(fitted, fitted)], beside.precision[fitted]), moment[fitted], lower=1)[0]
    return x


@dataclass(frozen=True, eq=False)
class _System:
    """Normal equations of all joints over the fitted unknowns: what is excluded costs nothing.

    Args:
        fitted: shape (n,), their indices in x.
        grams: shape (dof, n, n).
        moments: shape (dof, n).
        power: shape (dof,).
    """

    fitted: np.ndarray
    grams: np.ndarray
    moments: np.ndarray
    power: np.ndarray

    def errors(self, x: np.ndarray) -> np.ndarray:
        """|y − A x|² of each joint, at least rounding."""
        return np.maximum(self.power - 2.0 * self.moments @ x + (self.grams @ x) @ x, LEAST_ERROR * self.power)


def _stacked(design: Design, sums: Sequence[JointEquations], excluded: frozenset[int]) -> _System:
    """The equations without unknowns of excluded groups and of columns of zeros."""
    takes_part = design.scale > 0
    for i in excluded:
        takes_part[design.groups[i].unknowns] = False
    fitted = np.flatnonzero(takes_part)
    place, n = np.cumsum(takes_part) - 1, fitted.size
    grams, moments = np.zeros((len(sums), n, n)), np.zeros((len(sums), n))
    for j, (s, joint) in enumerate(zip(sums, design.joints, strict=True)):
        own = np.flatnonzero(takes_part[joint.unknowns])
        at = place[joint.unknowns[own]]
        grams[j][np.ix_(at, at)] = s.gram[np.ix_(own, own)]
        moments[j, at] = s.moment[own]
    return _System(fitted, grams, moments, np.array([s.power for s in sums]))


def _solve(system: _System, precision: np.ndarray, noise: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Posterior mean of x for given α and noise variances, and the lower triangle of its covariance."""
    n = system.fitted.size
    if not n:
        return np.zeros(0), np.zeros((0, 0))
    weights = _weights(noise)
    factor = _factor((weights @ system.grams.reshape(len(noise), n * n)).reshape(n, n), precision)
    return solved(factor, weights @ system.moments, lower=1)[0], inverted(factor, lower=1)[0]


def _weights(noise: np.ndarray) -> np.ndarray:
    return 1.0 / np.maximum(noise, LEAST_NOISE)


def _factor(gram: np.ndarray, precision: np.ndarray) -> np.ndarray:
    """Lower Cholesky factor of gram + diag α, in the place of gram."""
    gram[np.diag_indices_from(gram)] += precision + ROUNDING * np.trace(gram) / len(gram)
    factor, failed = factored(gram, lower=1)
    if failed:
        raise np.linalg.LinAlgError("the normal equations are not positive definite")
    return factor


@dataclass(frozen=True, eq=False)
class _Groups:
    """Fitted unknowns by their prior.

    Args:
        of: shape (n,), index of each unknown's group.
        sizes: shape (n_groups,), number of fitted unknowns.
        free: shape (n,), whether an unknown has the wide, fixed prior.
    """

    of: np.ndarray
    sizes: np.ndarray
    free: np.ndarray


def _fitted_groups(design: Design, fitted: np.ndarray) -> _Groups:
    of, free = np.zeros(design.n_unknowns, dtype=int), np.zeros(design.n_unknowns, dtype=bool)
    for i, group in enumerate(design.groups):
        of[group.unknowns], free[group.unknowns] = i, group.free
    return _Groups(of[fitted], np.bincount(of[fitted], minlength=len(design.groups)), free[fitted])


def _precisions(groups: _Groups, x: np.ndarray, spread: np.ndarray, before: np.ndarray) -> np.ndarray:
    """α of each unknown: γ over |x|² of its group."""
    n = groups.sizes.size
    determined = groups.sizes - np.bincount(groups.of, before * spread, n)
    power = np.maximum(np.bincount(groups.of, x**2, n), 1e-14)
    alpha = np.clip(np.maximum(determined, 1e-3) / power, LEAST_PRECISION, MOST_PRECISION)
    return np.where(groups.free, FREE, alpha[groups.of])


def _over_all(n: int, fitted: np.ndarray, found: Ridge) -> Ridge:
    """A fit, with the lower triangle of its covariance, over all unknowns: those that are not fitted are zero."""
    x, covariance, precision = np.zeros(n), np.zeros((n, n)), np.full(n, EXCLUDED)
    x[fitted], precision[fitted] = found.x, found.precision
    lower = np.tril(found.covariance)
    covariance[np.ix_(fitted, fitted)] = lower + np.tril(lower, -1).T
    return Ridge(x, covariance, found.variance, precision)
