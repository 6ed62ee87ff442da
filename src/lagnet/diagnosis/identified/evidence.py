"""argmax p(x | α, σ²) with α, σ² at the maximum of the evidence: ridge regression of all joints together.

With unknowns x ~ N(0, 1/α_g) and errors of joint j ~ N(0, s σ_j²), the fixed point of MacKay 1992 sets α_g to
γ_g / |x_g|², γ_g the number of unknowns that the data determine, and σ_j² to the mean squared error. The statistical
inefficiency s accounts for errors of filtered motion, which are correlated: s samples have the information of one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from lagnet.diagnosis.identified.design import Design, Group

STEPS = 30  # of the fixed point
LEAST_PRECISION, MOST_PRECISION = 1e-6, 1e8  # α: columns are in parts of the joint's torque
FREE = 1e-8  # α of unknowns without a prior
START = 1e-4  # initial α
EXCLUDED = 1e14  # α of unknowns that are excluded
ROUNDING = 1e-10  # of the mean diagonal
LEAST_ERROR = 1e-12  # of the power of the target


@dataclass(frozen=True, eq=False)
class JointEquations:
    """AᵀA x = Aᵀy of one joint: gram (p, p), moment (p,), power |y|² and number of samples."""

    gram: np.ndarray
    moment: np.ndarray
    power: float
    n_samples: float

    def __sub__(self, other: JointEquations) -> JointEquations:
        return JointEquations(
            self.gram - other.gram,
            self.moment - other.moment,
            self.power - other.power,
            self.n_samples - other.n_samples,
        )

    def error(self, x: np.ndarray) -> float:
        """|y − A x|², at least rounding."""
        return max(self.power - 2.0 * float(x @ self.moment) + float(x @ self.gram @ x), LEAST_ERROR * self.power)


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


def joint_equations(design: Design, rows: np.ndarray | slice = slice(None)) -> tuple[JointEquations, ...]:
    """Normal equations of each joint over some rows, without samples at rest."""
    out = []
    for joint in design.joints:
        keep = joint.valid[rows]
        a, y = joint.columns[rows][keep], joint.target[rows][keep]
        out.append(JointEquations(a.T @ a, a.T @ y, float(y @ y), float(keep.sum())))
    return tuple(out)


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
    n_samples = np.array([max(s.n_samples, 1.0) for s in sums])
    power = np.array([max(s.power, 1e-300) for s in sums]) / n_samples
    variance = 0.1 * power if start is None else start.variance
    precision = np.full(design.n_unknowns, START) if start is None else np.minimum(start.precision, MOST_PRECISION)
    out = np.concatenate([np.zeros(0, dtype=int), *(design.groups[i].unknowns for i in sorted(excluded))])
    for _ in range(steps):
        precision[out] = EXCLUDED
        x, covariance = _solve(design, sums, precision, inefficiency * variance)
        precision = _precisions(design.groups, design.scale, x, np.diag(covariance), precision)
        errors = np.array([s.error(x[j.unknowns]) for s, j in zip(sums, design.joints, strict=True)])
        variance = np.maximum(errors / n_samples, LEAST_ERROR * power)
    precision[out] = EXCLUDED
    x, covariance = _solve(design, sums, precision, inefficiency * variance)
    return Ridge(x, covariance, variance, precision)


def _solve(
    design: Design, sums: Sequence[JointEquations], precision: np.ndarray, noise: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Posterior mean and covariance of x for given α and noise variances."""
    n = design.n_unknowns
    gram, moment = np.zeros((n, n)), np.zeros(n)
    for s, joint, power in zip(sums, design.joints, noise, strict=True):
        gram[np.ix_(joint.unknowns, joint.unknowns)] += s.gram / power
        moment[joint.unknowns] += s.moment / power
    gram[np.diag_indices(n)] += precision + ROUNDING * np.trace(gram) / n
    factor = cho_factor(gram, lower=True)
    return cho_solve(factor, moment), cho_solve(factor, np.eye(n))


def _precisions(
    groups: Sequence[Group], scale: np.ndarray, x: np.ndarray, spread: np.ndarray, before: np.ndarray
) -> np.ndarray:
    out = before.copy()
    for group in groups:
        own = group.unknowns[scale[group.unknowns] > 0]
        if group.free:
            out[own] = FREE
        elif own.size:
            determined = own.size - float(before[own] @ spread[own])
            out[own] = np.clip(
                max(determined, 1e-3) / max(float(x[own] @ x[own]), 1e-14), LEAST_PRECISION, MOST_PRECISION
            )
    return out
