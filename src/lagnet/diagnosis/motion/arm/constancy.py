"""Does a parameter hold through each recording? e = −J x − τ J_p δ over windows, τ from −1 to 1 through a recording.

A cause of the catalogue has one value. What fades, warms up or runs down within every recording leaves a mean value
that the same effect explains, and a trend about it: with p = p̄ + δ τ a gain that falls from nominal has δ as large as
the change of its mean. One Gauss–Newton step from the fitted law gives δ, with the sandwich covariance of the windows'
scores; rollouts with that trend must bear it out. Source: White 1982.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.motion.joint.cases import windows_to_fit
from lagnet.diagnosis.motion.joint.fitting import (
    HUBER,
    Coordinates,
    JointData,
    free_coordinates,
    robust_scale,
    sensitivities,
)
from lagnet.diagnosis.motion.joint.intervals import NORMAL_95
from lagnet.diagnosis.motion.joint.joint_case import JointCase, sizes_of
from lagnet.diagnosis.motion.joint.refitting import groups_of
from lagnet.diagnosis.motion.problem import MotionProblem

CHANGES_WITHIN = "changes_within_recordings"  # rule: its value does not hold through a recording
LEAST_RIDGE = 1e-9
LEAST_SHOWN = 0.5  # of the fall of the cost that slopes promise
LEVELS = np.linspace(-1.0, 1.0, 5)  # of τ, at which rollouts are made


@dataclass(frozen=True)
class Trend:
    """Change of a parameter from the middle of recordings to their ends.

    Args:
        parameter: name in the law.
        share: |δ| over |p − p₀|, what the effect changes.
        least: the lower end of its 95 % interval.
        shown: fall of the cost in rollouts whose parameter follows the trend, over the fall that the slopes promise.
    """

    parameter: str
    share: float
    least: float
    shown: float

    def is_more_than(self, share: float) -> bool:
        """Whether it is, not by scatter alone, and rollouts bear it out: those of stick and slip have false slopes."""
        return self.share > share and self.least > 0.0 and self.shown > LEAST_SHOWN


def trends_of(
    problem: MotionProblem, fitted: int, joint: int, case: JointCase, law: np.ndarray, effects: tuple[str, ...]
) -> dict[str, Trend]:
    """For each effect the trend of the parameter that it changes most, in sizes of its own scale.

    Args:
        problem: all recordings, the first `fitted` of them fitted.
        fitted: number of them.
        joint: its index.
        case: its nominal law, scales and resolution.
        law: with the named effects, shape (len(LAW),).
        effects: those named.
    """
    data = replace(case.fit, windows=windows_to_fit(problem, fitted, joint))
    coordinates = free_coordinates(groups_of(case, effects), law, sizes_of(case.scales))
    fit = _fit_of(data, coordinates, law, case.floor, _through(problem, len(data.series.q)))
    changed = np.abs(coordinates.read(law) - coordinates.read(case.law)) / coordinates.sizes
    out = {}
    for effect in effects:
        own = [coordinates.groups.index(g) for g in groups_of(case, (effect,)) if g in coordinates.groups]
        if own and max(changed[own]) > 0.0:
            i = max(own, key=lambda k: changed[k])
            out[effect] = fit.trend(i, float(changed[i]))
    return out


@dataclass(frozen=True, eq=False)
class _Fit:
    """A law at its least cost, with slopes and weights of every sample.

    Args:
        data, coordinates, law: what was fitted.
        through: place of every sample in its recording, −1 to 1.
        residual, weight: shape (n,).
        jacobian: shape (n, k), in units of the coordinates' sizes.
    """

    data: JointData
    coordinates: Coordinates
    law: np.ndarray
    through: np.ndarray
    residual: np.ndarray
    weight: np.ndarray
    jacobian: np.ndarray

    def trend(self, i: int, changed: float) -> Trend:
        """That of coordinate i, which the effect changes by so many of its sizes."""
        columns = np.column_stack([self.jacobian, self.jacobian[:, i] * self.through])
        windows = self.data.windows
        rows = list(zip(windows.first, windows.last, strict=True))
        step, error, promised = _step(columns, self.residual, self.weight, rows)
        least, shown = abs(step[-1]) - NORMAL_95 * error, self._fall(step, i) / max(promised, 1e-300)
        return Trend(self.coordinates.groups[i][0], abs(float(step[-1])) / changed, least / changed, shown)

    def _fall(self, step: np.ndarray, i: int) -> float:
        """½ Σ w (e² − e'²), e' of rollouts with p = p̄ + δ τ, between those of five levels of τ."""
        values = self.coordinates.read(self.law) + self.coordinates.sizes * step[:-1]
        along = step[-1] * self.coordinates.sizes[i] * np.eye(len(values))[i]
        found = self.data.predict(self.coordinates.write(self.law, values + LEVELS[:, None] * along))
        place = np.interp(self.through, LEVELS, np.arange(len(LEVELS)))
        low = np.minimum(place.astype(int), len(LEVELS) - 2)
        sample = np.arange(len(place))
        predicted = found[low, sample] + (place - low) * (found[low + 1, sample] - found[low, sample])
        return 0.5 * float(np.sum(self.weight * (self.residual**2 - (predicted - self.data.series.q) ** 2)))


def _fit_of(data: JointData, coordinates: Coordinates, law: np.ndarray, floor: float, through: np.ndarray) -> _Fit:
    predicted = data.predict(law)[0]
    jacobian = sensitivities(data, coordinates, law, predicted)
    residual = predicted - data.series.q
    weight = 1.0 / np.maximum(1.0, np.abs(residual) / (HUBER * robust_scale(residual, floor)))
    return _Fit(data, coordinates, law, through, residual, weight, jacobian)


def _through(problem: MotionProblem, count: int) -> np.ndarray:
    """Place of every sample in its recording, −1 at its begin and 1 at its end, shape (n,)."""
    out = np.zeros(count)
    for recording in {run.recording for run in problem.runs}:
        runs = [run for run in problem.runs if run.recording == recording]
        first, last = min(run.first for run in runs), max(run.last for run in runs)
        out[first : last + 1] = np.linspace(-1.0, 1.0, last - first + 1)
    return out


def _step(
    columns: np.ndarray, residual: np.ndarray, weight: np.ndarray, rows: list[tuple[int, int]]
) -> tuple[np.ndarray, float, float]:
    """Gauss–Newton step, the standard error of its last entry over windows, and the fall of the cost it promises."""
    scores = np.array([columns[a : b + 1].T @ (weight[a : b + 1] * residual[a : b + 1]) for a, b in rows])
    normal = (columns * weight[:, None]).T @ columns
    ridge = LEAST_RIDGE * max(float(np.trace(normal)), 1e-30) / len(normal)
    inverse = np.linalg.inv(normal + ridge * np.eye(len(normal)))
    whole = scores.sum(axis=0)
    step = -inverse @ whole
    centred = scores - scores.mean(axis=0)
    count = len(scores)
    covariance = inverse @ (centred.T @ centred) @ inverse * count / max(1, count - len(normal))
    return step, float(np.sqrt(max(covariance[-1, -1], 0.0))), -0.5 * float(whole @ step)
