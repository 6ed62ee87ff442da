"""When a parameter changed, at equal temperature and load: steps and drifts, each tried at every recording.

For a candidate column c, the score z = cᵀ P y / √(cᵀ P c) is standard normal (Student's t where the scatter is
estimated) as long as nothing changed, with P the inverse covariance of the series less its level, earlier changes and
what temperature and load explain. The p value is that of the largest |z| times the number of candidates (Boole), which
is somewhat cautious since neighbouring candidates are alike. A single recording that stands apart from those before and
after it is an outlier and no change. Source: andrews1993, bai1998.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import t as student

from lagnet.tracking.statistics.covariates import CovariateModel
from lagnet.tracking.statistics.series import Series

KINDS = ("step", "drift")
NEAR = 3.84  # drop of z² within which another date is as likely, for a 95 % interval
APART = 4.0  # score from which a single recording counts as an outlier


@dataclass(frozen=True)
class Change:
    """A change of one parameter.

    Args:
        kind: step or drift.
        index: of the first recording that shows a step, or at which a drift sets in.
        earliest, latest: between which indices the date lies with 95 %.
        size: of a step, or of a drift up to the last recording, on the scale of the series.
        sigma: standard deviation of the size.
        p_value: that nothing but noise, temperature and load makes as large a score.
    """

    kind: str
    index: int
    earliest: int
    latest: int
    size: float
    sigma: float
    p_value: float


def column_of(kind: str, index: int, days: np.ndarray) -> np.ndarray:
    """What a change of size one adds, shape (n,): 1 from a step on, and a drift that ends at 1."""
    if kind == "step":
        return (np.arange(days.size) >= index).astype(float)
    rising = np.maximum(days - days[index], 0.0)
    return rising / max(rising[-1], 1e-12)


def scan(series: Series, model: CovariateModel, known: Sequence[Change] = ()) -> Change | None:
    """The likeliest further change of a series; None where it is too short.

    Args:
        series: without outliers.
        model: of its group.
        known: changes that are taken out.
    """
    n = series.days.size
    candidates = [("step", k) for k in range(1, n)] + [
        ("drift", k) for k in range(n - 2) if series.days[-1] > series.days[k]
    ]
    if n < 2 + len(known) + 1 or not candidates:
        return None
    columns = np.column_stack([column_of(kind, k, series.days) for kind, k in candidates])
    z, power = _scores(series, model, known, columns)
    if not np.isfinite(z).any():
        return None
    best = int(np.nanargmax(np.abs(z)))
    kind, index = candidates[best]
    near = [
        k for (name, k), score in zip(candidates, z, strict=True) if name == kind and z[best] ** 2 - score**2 < NEAR
    ]
    p = min(1.0, len(candidates) * 2.0 * float(student.sf(abs(z[best]), model.freedom)))
    size = float(z[best] / np.sqrt(power[best]))
    return Change(kind, index, min(near), max(near), size, float(1.0 / np.sqrt(power[best])), p)


def outliers(series: Series, model: CovariateModel) -> tuple[int, ...]:
    """Recordings that stand apart from those before and after them, more than any step or drift explains."""
    left, out = series, []
    while left.days.size > 4:
        n = left.days.size
        spikes, _ = _scores(left, model, (), np.eye(n)[:, 1:-1])
        steps, _ = _scores(left, model, (), np.tril(np.ones((n, n)))[:, 1:])
        worst = int(np.argmax(np.abs(np.nan_to_num(spikes))))
        if not abs(spikes[worst]) > max(APART, float(np.nanmax(np.abs(steps)))):
            break
        out.append(series.observations.index(left.observations[worst + 1]))
        left = left.without([worst + 1])
    return tuple(sorted(out))


def _scores(
    series: Series, model: CovariateModel, known: Sequence[Change], columns: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """z and cᵀ P c of each column, shapes (k,); NaN where a column is nothing beside what is known."""
    half = np.linalg.cholesky(model.total_covariance(series))
    taken = np.column_stack([np.ones(series.days.size), *(column_of(c.kind, c.index, series.days) for c in known)])
    q = np.linalg.qr(np.linalg.solve(half, taken))[0]
    rest = np.linalg.solve(half, series.value - model.columns(series) @ model.slopes)
    rest -= q @ (q.T @ rest)
    free = np.linalg.solve(half, columns)
    before = np.sum(free**2, axis=0)
    free -= q @ (q.T @ free)
    power = np.sum(free**2, axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(power > 1e-9 * before, free.T @ rest / np.sqrt(power), np.nan), power


@dataclass(frozen=True, eq=False)
class Levels:
    """A series told apart: its level at usual temperature and load, and what these two explain.

    Args:
        first, last: level at the first and the last recording.
        sigma_last: standard deviation of the last.
        explained: shape (n, 2), by temperature and by load.
    """

    first: float
    last: float
    sigma_last: float
    explained: np.ndarray


def levels(series: Series, model: CovariateModel, known: Sequence[Change]) -> Levels:
    """Level and changes by generalised least squares; the robot's own slopes are its best linear prediction."""
    total = model.total_covariance(series)
    taken = np.column_stack([np.ones(series.days.size), *(column_of(c.kind, c.index, series.days) for c in known)])
    x = model.columns(series)
    weighted = np.linalg.solve(total, taken)
    covariance = np.linalg.pinv(taken.T @ weighted)
    seen = series.value - x @ model.slopes
    fitted = covariance @ (weighted.T @ seen)
    slopes = model.slopes + model.covariance @ x.T @ np.linalg.solve(total, seen - taken @ fitted)
    last = taken[-1]
    return Levels(float(taken[0] @ fitted), float(last @ fitted), float(np.sqrt(last @ covariance @ last)), x * slopes)
