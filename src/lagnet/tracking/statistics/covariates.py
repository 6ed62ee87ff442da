"""What temperature and load do to a parameter: slopes of each robot, pooled over the robots of its make.

    y_i = a_i + X_i b_i + changes + e_i,   b_i ~ N(β, D),   e ~ N(0, φ s² + b_T² σ_T² + σ²)

y is the parameter of one robot over time, X temperature [10 K] and relative load about those usual in the make, s the
standard deviation of each fit, σ what differs from recording to recording beyond it. β and D come from all robots by
expectation maximisation, with a drift and a step of each robot taken out: wear of one does not pass for warmth of all.
A robot that only ever warmed up is thus judged by the slopes of its sisters. Errors of the thermometer flatten a slope,
most where temperature hardly varies; the slopes are corrected for that. Source: laird1982, fuller1987, bittencourt2012.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import brentq
from scipy.stats import chi2

from lagnet.tracking.statistics.followed_law import stage_of
from lagnet.tracking.statistics.series import Series

KELVIN = 10.0  # unit of the temperature's column [K]
WIDE = np.array([0.5, 1.0])  # prior standard deviation of β: of the parameter, per 10 K and per load doubled
USUAL = np.array([0.1, 0.2])  # by which slopes of sisters are taken to differ while few are known
USUAL_WEIGHT = 2.0  # robots that this counts for
FEW, MANY = 4, 7  # recordings from which a step, and from which drift and covariates beside it, are taken out
ROUNDS = 60  # of expectation maximisation
EFFICIENCY = 0.6  # of a median against a mean, in degrees of freedom
TRUSTED = 20.0  # degrees of freedom from which intervals found too wide are narrowed
NARROWEST = 0.25  # φ at least
THERMOMETER = 0.5  # σ_T [K]: the friction sits in gear and bearings, the thermometer in the motor or the room


@dataclass(frozen=True, eq=False)
class CovariateModel:
    """What a group of series has in common.

    Args:
        usual: temperature [°C] and load [N m] to which parameters are brought.
        slopes: β, shape (2,).
        covariance: of a robot's slopes about β, known and unknown parts together, shape (2, 2).
        inflation: φ.
        extra: σ², variance between recordings.
        freedom: degrees of freedom behind σ² and φ.
        warmth: variance that an error of the thermometer makes, b_T² σ_T².
    """

    usual: np.ndarray
    slopes: np.ndarray
    covariance: np.ndarray
    inflation: float
    extra: float
    freedom: float
    warmth: float = 0.0

    def columns(self, series: Series) -> np.ndarray:
        """X, shape (n, 2); zeros where a covariate is not known throughout."""
        return _columns(series, self.usual)

    def noise(self, series: Series) -> np.ndarray:
        """Variance of each recording about the model, shape (n,)."""
        return self.inflation * series.sigma**2 + self.warmth * _is_warm(self.columns(series)) + self.extra

    def total_covariance(self, series: Series) -> np.ndarray:
        """Covariance of a series about level, changes and β, shape (n, n)."""
        x = self.columns(series)
        return np.diag(self.noise(series)) + x @ self.covariance @ x.T


def fit_covariates(group: Sequence[Series], thermometer: float = THERMOMETER) -> CovariateModel:
    """Slopes and scatter of one parameter over the robots of a make.

    Args:
        group: one series a robot.
        thermometer: σ_T, standard deviation between the temperature told and that of the joint's friction [K].
    """
    usual = _usual(group)
    scale = (
        1.0 if group[0].logarithmic else max(float(np.median(np.abs(np.concatenate([s.value for s in group])))), 1e-12)
    )
    tables = [_columns(s, usual) for s in group]
    own = [np.maximum(s.sigma**2, 1e-16) for s in group]
    warm, warmth = [np.zeros(v.size) for v in own], 0.0
    nuisance = [_nuisance(s, x, v) for s, x, v in zip(group, tables, own, strict=True)]
    extra, inflation, freedom = 0.0, 1.0, 1.0
    slopes, covariance = np.zeros(2), np.diag((scale * WIDE) ** 2)
    for _ in range(3):
        variance = [inflation * v + w + extra for v, w in zip(own, warm, strict=True)]
        slopes, covariance = _pooled(group, tables, nuisance, variance, scale, thermometer / KELVIN)
        warmth = float(slopes[0] ** 2 + covariance[0, 0]) * (thermometer / KELVIN) ** 2
        warm = [np.full(len(x), warmth * _is_warm(x)) for x in tables]
        inflation, extra, freedom = _scatter(group, tables, nuisance, own, warm, slopes)
    return CovariateModel(usual, slopes, covariance, inflation, extra, freedom, warmth)


def _is_warm(columns: np.ndarray) -> bool:
    return bool(np.ptp(columns[:, 0]) > 0.0)


def _usual(group: Sequence[Series]) -> np.ndarray:
    out = []
    for name in ("temperature", "load"):
        values = np.concatenate([getattr(s, name) for s in group])
        finite = values[np.isfinite(values)]
        out.append(float(np.median(finite)) if finite.size else np.nan)
    return np.array(out)


def _columns(series: Series, usual: np.ndarray) -> np.ndarray:
    stage = stage_of(series.group[2])
    warmth = (series.temperature - usual[0]) / KELVIN
    load = series.load / usual[1] - 1.0 if usual[1] > 0 else np.full(series.days.size, np.nan)
    apply = (stage != "body", stage == "torque")  # bodies do not warm, and load acts on friction
    kept = [
        c if on and np.isfinite(c).all() else np.zeros(series.days.size)
        for c, on in zip((warmth, load), apply, strict=True)
    ]
    return np.column_stack(kept)


def _nuisance(series: Series, x: np.ndarray, variance: np.ndarray) -> np.ndarray:
    """Level, drift and the step that fits best beside them and the covariates, as far as n allows, shape (n, k)."""
    n = series.days.size
    base = np.ones((n, 1))
    if n < FEW:
        return base
    if n >= MANY:
        base = np.column_stack([base, series.days / max(series.days[-1], 1e-9)])
    root = 1.0 / np.sqrt(variance)
    steps = np.tril(np.ones((n, n)))[:, 1:]
    beside = x[:, np.ptp(x, axis=0) > 0] if n >= MANY else x[:, :0]
    known = np.linalg.qr(np.column_stack([base, beside]) * root[:, None])[0]
    free = steps * root[:, None]
    free -= known @ (known.T @ free)
    rest = series.value * root
    rest -= known @ (known.T @ rest)
    power = np.sum(free**2, axis=0)
    gain = np.where(power > 1e-9, (free.T @ rest) ** 2 / np.maximum(power, 1e-9), 0.0)
    return np.column_stack([base, steps[:, int(np.argmax(gain))]])


def _pooled(
    group: Sequence[Series],
    tables: Sequence[np.ndarray],
    nuisance: Sequence[np.ndarray],
    variance: Sequence[np.ndarray],
    scale: float,
    thermometer: float,
) -> tuple[np.ndarray, np.ndarray]:
    """β, and the covariance of a robot's slopes about it: D and what is not known of β."""
    information, moments = [], []
    for series, x, n, v in zip(group, tables, nuisance, variance, strict=True):
        root = 1.0 / np.sqrt(v)[:, None]
        q = np.linalg.qr(n * root)[0]
        free = x * root - q @ (q.T @ (x * root))
        errors = thermometer**2 * float(np.sum((1.0 - np.sum(q**2, axis=1)) * root[:, 0] ** 2))
        calibrated = _calibrated(free.T @ free, errors)
        information.append(calibrated @ (free.T @ free) @ calibrated.T)
        moments.append(calibrated @ free.T @ (series.value * root[:, 0]))
    known, total = np.array(information), np.array(moments)
    prior = np.diag((scale * WIDE) ** -2)
    usual = np.diag((scale * USUAL) ** 2)
    spread, mean = usual.copy(), np.zeros(2)
    for _ in range(ROUNDS):
        inverse = np.linalg.inv(spread)
        posterior = np.linalg.inv(known + inverse)
        slopes = np.einsum("rij,rj->ri", posterior, total + inverse @ mean)
        mean = np.linalg.solve(len(known) * inverse + prior, inverse @ slopes.sum(axis=0))
        about = slopes - mean
        # Robots that say nothing of a slope do not confirm how much slopes differ.
        told = np.clip(1.0 - np.einsum("rii,i->r", posterior, np.diag(inverse)) / 2.0, 0.0, 1.0)
        scatter = np.einsum("r,ri,rj->ij", told, about, about) + np.einsum("r,rij->ij", told, posterior)
        spread = (scatter + USUAL_WEIGHT * usual) / (told.sum() + USUAL_WEIGHT)
    marginal = known @ np.linalg.inv(np.eye(2) + spread @ known)
    return mean, spread + np.linalg.inv(marginal.sum(axis=0) + prior)


def _calibrated(power: np.ndarray, errors: float) -> np.ndarray:
    """C = (K − N) K⁻¹ of regression calibration, shape (2, 2).

    Errors of the thermometer make the moments Xᵀy = (K − N) b + noise of covariance K, smaller than K b: a slope taken
    from K⁻¹ Xᵀy would be too flat. Source: fuller1987.

    Args:
        power: K = XᵀX, shape (2, 2).
        errors: N for the temperature, what the thermometer's errors add to K.
    """
    true = power.copy()
    true[0, 0] = max(power[0, 0] - errors, float(power[0, 1] ** 2 / power[1, 1]) if power[1, 1] > 0.0 else 0.0)
    return true @ np.linalg.pinv(power, hermitian=True)


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """Where a function changes its sign between two values, to a thousandth."""
    found: Any = brentq(function, low, high, xtol=1e-3 * high)
    return float(found)


def _scatter(
    group: Sequence[Series],
    tables: Sequence[np.ndarray],
    nuisance: Sequence[np.ndarray],
    own: Sequence[np.ndarray],
    warm: Sequence[np.ndarray],
    slopes: np.ndarray,
) -> tuple[float, float, float]:
    """φ, σ² and their degrees of freedom: the median robot scatters as much as it should."""

    def ratios(inflation: float, extra: float) -> tuple[np.ndarray, np.ndarray]:
        powers, counts = [], []
        for series, x, n, v, w in zip(group, tables, nuisance, own, warm, strict=True):
            root = 1.0 / np.sqrt(inflation * v + w + extra)
            taken = np.column_stack([n, x[:, np.ptp(x, axis=0) > 0]]) if series.days.size >= MANY else n
            q = np.linalg.qr(taken * root[:, None])[0]
            rest = (series.value - (0.0 if taken is not n else x @ slopes)) * root
            rest -= q @ (q.T @ rest)
            powers.append(float(rest @ rest))
            counts.append(max(0.5, rest.size - taken.shape[1] - (n.shape[1] > 1)))  # the place of a step is chosen too
        return np.array(powers), np.array(counts)

    _, counts = ratios(1.0, 0.0)
    freedom = max(2.0, float(counts.sum()) * (1.0 if len(group) < 3 else EFFICIENCY))

    def excess(inflation: float, extra: float) -> float:
        powers, counts = ratios(inflation, extra)
        if len(group) < 3:
            return float(powers.sum() / counts.sum()) - 1.0
        return float(np.median(powers / chi2.ppf(0.5, counts))) - 1.0

    at_zero = excess(1.0, 0.0)
    if at_zero <= 0.0:
        least = NARROWEST if freedom >= TRUSTED else 1.0
        if excess(least, 0.0) <= 0.0:
            return least, 0.0, freedom
        return root(lambda f: excess(f, 0.0), least, 1.0), 0.0, freedom
    most = 10.0 * (1.0 + at_zero) * max(float(np.max(v + w)) for v, w in zip(own, warm, strict=True))
    extra = root(lambda e: excess(1.0, e), 0.0, most) if excess(1.0, most) < 0 else most
    return 1.0, float(extra), freedom
