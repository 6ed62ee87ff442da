"""Ridge regression of all joints together, with prior widths of groups and noise of joints set by the evidence.

With unknowns x ~ N(0, 1/α_g) and errors of joint j ~ N(0, s σ_j²), the fixed point of MacKay 1992 sets α_g to
γ_g / |x_g|², γ_g the number of unknowns that the data determine, and σ_j² to the mean squared error. The temper s says
that errors of filtered motion hang together: s samples count as one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from lagnet.diagnosis.identified.design import Design, Group

STEPS = 30  # of the fixed point
WIDEST, NARROWEST = 1e-6, 1e8  # least and largest α: columns are in parts of the joint's torque
FREE = 1e-8  # α of what nothing draws to zero
START = 1e-4  # α at first
BARRED = 1e14  # α of what is left out
ROUNDING = 1e-10  # of the mean diagonal
LEAST_ERROR = 1e-12  # of the power of the target


@dataclass(frozen=True, eq=False)
class Sums:
    """Normal equations of one joint: shape (p, p), (p,), power of the target and number of samples."""

    gram: np.ndarray
    moment: np.ndarray
    power: float
    count: float

    def __sub__(self, other: Sums) -> Sums:
        return Sums(
            self.gram - other.gram, self.moment - other.moment, self.power - other.power, self.count - other.count
        )

    def error(self, x: np.ndarray) -> float:
        """Squared error of unknowns, at least rounding."""
        return max(self.power - 2.0 * float(x @ self.moment) + float(x @ self.gram @ x), LEAST_ERROR * self.power)


@dataclass(frozen=True, eq=False)
class Ridge:
    """Outcome of a fit.

    Args:
        x: shape (n_unknowns,), scaled unknowns.
        covariance: shape (n_unknowns, n_unknowns), of their posterior.
        variance: shape (dof,), squared error of each joint [N² m²].
        precision: shape (n_unknowns,), α of each unknown.
    """

    x: np.ndarray
    covariance: np.ndarray
    variance: np.ndarray
    precision: np.ndarray


def sums_of(design: Design, rows: np.ndarray | slice = slice(None)) -> tuple[Sums, ...]:
    """Normal equations of each joint over some rows, samples at rest left out."""
    out = []
    for joint in design.joints:
        keep = joint.valid[rows]
        a, y = joint.columns[rows][keep], joint.target[rows][keep]
        out.append(Sums(a.T @ a, a.T @ y, float(y @ y), float(keep.sum())))
    return tuple(out)


def fit_ridge(
    design: Design,
    sums: Sequence[Sums],
    temper: float,
    start: Ridge | None = None,
    steps: int = STEPS,
    barred: frozenset[int] = frozenset(),
) -> Ridge:
    """Unknowns with the prior widths and noise that the evidence prefers.

    Args:
        design: where unknowns belong.
        sums: normal equations of each joint.
        temper: samples that count as one.
        start: a fit whose widths and noise are begun with.
        steps: of the fixed point.
        barred: indices of groups that are left out.
    """
    counts = np.array([max(s.count, 1.0) for s in sums])
    power = np.array([max(s.power, 1e-300) for s in sums]) / counts
    variance = 0.1 * power if start is None else start.variance
    precision = np.full(design.n_unknowns, START) if start is None else np.minimum(start.precision, NARROWEST)
    out = np.concatenate([np.zeros(0, dtype=int), *(design.groups[i].unknowns for i in sorted(barred))])
    for _ in range(steps):
        precision[out] = BARRED
        x, covariance = _solve(design, sums, precision, temper * variance)
        precision = _precisions(design.groups, design.scale, x, np.diag(covariance), precision)
        errors = np.array([s.error(x[j.unknowns]) for s, j in zip(sums, design.joints, strict=True)])
        variance = np.maximum(errors / counts, LEAST_ERROR * power)
    precision[out] = BARRED
    x, covariance = _solve(design, sums, precision, temper * variance)
    return Ridge(x, covariance, variance, precision)


def _solve(
    design: Design, sums: Sequence[Sums], precision: np.ndarray, noise: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Mean and covariance of the unknowns for given widths and noise."""
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
            out[own] = np.clip(max(determined, 1e-3) / max(float(x[own] @ x[own]), 1e-14), WIDEST, NARROWEST)
    return out
