"""Linear fits of a column on what it may hold, each judged on stretches of time that it was not fitted to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.effort_column.samples import BLOCKS, EffortSamples

ROUNDS = 8  # of giving a magnitude the sign of its prediction
SAME = 1e-4  # share of a column that others leave, below which it is one of them
NOTHING = 1e-6  # of the largest nominal torque: a joint that gravity does not load at all


@dataclass(frozen=True, eq=False)
class Fit:
    """One joint's column as a sum of terms.

    Args:
        terms: names of the terms.
        value, sigma: shape (k,), coefficients and their standard deviations, by leaving out stretches of time.
        explained: share of the column's variance that is predicted in stretches left out, at most 1.
        rms: shape (k,), root mean square of each term's part, mean taken off.
        power: mean square of the column, mean taken off.
    """

    terms: tuple[str, ...]
    value: np.ndarray
    sigma: np.ndarray
    explained: float
    rms: np.ndarray
    power: float

    def of(self, term: str) -> tuple[float, float]:
        """Coefficient and standard deviation; (0, inf) for a term that could not be told from others."""
        if term not in self.terms:
            return 0.0, np.inf
        k = self.terms.index(term)
        return float(self.value[k]), float(self.sigma[k])

    def share(self, *terms: str) -> float:
        """Root mean square of terms over that of the column."""
        sizes = [self.rms[self.terms.index(t)] for t in terms if t in self.terms]
        return float(np.sqrt(np.sum(np.square(sizes)) / max(self.power, 1e-300)))


def columns_of(samples: EffortSamples, joint: int) -> dict[str, np.ndarray]:
    """Every term that a column of a joint may hold, shape (n,) each."""
    largest = float(np.max(np.abs(samples.gravity))) + float(np.max(np.abs(samples.dynamic)))
    gravity = samples.gravity[:, joint]
    found = {
        "gravity": gravity * (np.max(np.abs(gravity)) > NOTHING * largest),
        "dynamic": samples.dynamic[:, joint],
        "rotor": samples.a[:, joint],
        "viscous": samples.v[:, joint],
        "coulomb": samples.sign(joint),
        "q": samples.q[:, joint],
    }
    if samples.error is not None:
        found["error"] = samples.error[:, joint]
    return found


def fit(samples: EffortSamples, joint: int, terms: tuple[str, ...], magnitude: bool = False) -> Fit:
    """Fit a joint's column on terms and a constant, and predict each stretch of time from the others.

    Args:
        magnitude: the column is the size of the sum, without its sign.
    """
    rows = samples.within_range(joint)
    named = {name: column[rows] for name, column in columns_of(samples, joint).items()}
    terms = tuple(t for t in terms if t in named)
    y, block = samples.y[rows, joint], samples.block[rows]
    if magnitude:
        y = y * _signs(terms, named, y)
    terms = _distinct(terms, named)
    x = np.stack([*(named[t] for t in terms), np.ones(len(y))], axis=1)
    value = _solve(x, y)
    leave_out, predicted = [], np.empty_like(y)
    for b in range(BLOCKS):
        inside = block == b
        if not inside.any() or inside.all():
            predicted[inside] = y[inside].mean() if inside.any() else 0.0
            continue
        without = _solve(x[~inside], y[~inside])
        leave_out.append(without)
        predicted[inside] = x[inside] @ without
    spread = np.array(leave_out) if leave_out else np.tile(value, (2, 1))
    k = len(spread)
    sigma = np.sqrt((k - 1) / k * np.sum((spread - spread.mean(axis=0)) ** 2, axis=0))
    seen, said = (np.abs(y), np.abs(predicted)) if magnitude else (y, predicted)
    power = float(np.var(seen))
    explained = 1.0 - float(np.mean((seen - said) ** 2)) / max(power, 1e-300)
    parts = x[:, :-1] * value[:-1]
    return Fit(terms, value[:-1], sigma[:-1], explained, parts.std(axis=0), float(np.var(y)))


def _solve(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    size = np.maximum(np.sqrt(np.mean(x**2, axis=0)), 1e-300)
    return np.linalg.lstsq(x / size, y, rcond=1e-8)[0] / size


def _distinct(terms: tuple[str, ...], named: dict[str, np.ndarray]) -> tuple[str, ...]:
    """The terms without those that earlier ones already span (a rotor beside the only body, gravity of a flat arm)."""
    kept: list[str] = []
    for term in terms:
        column = named[term]
        x = np.stack([*(named[t] for t in kept), np.ones(len(column))], axis=1)
        left = column - x @ _solve(x, column)
        if np.mean(left**2) > SAME * float(np.mean(column**2)):
            kept.append(term)
    return tuple(kept)


def _signs(terms: tuple[str, ...], named: dict[str, np.ndarray], y: np.ndarray) -> np.ndarray:
    """Signs that make a magnitude a torque: at first those of the nominal torque with some friction, then the fit's."""
    nominal = named["gravity"] + named["dynamic"]
    best, least = np.ones_like(y), np.inf
    x = np.stack([*(named[t] for t in terms), np.ones(len(y))], axis=1)
    for friction in (0.0, 0.5, 2.0):
        sign = np.sign(nominal + friction * max(float(nominal.std()), 1e-12) * named["coulomb"])
        for _ in range(ROUNDS):
            said = x @ _solve(x, y * sign)
            fresh = np.where(said < 0, -1.0, 1.0)
            if np.array_equal(fresh, sign):
                break
            sign = fresh
        left = float(np.mean((y - np.abs(x @ _solve(x, y * sign))) ** 2))
        if left < least:
            best, least = sign, left
    return best
