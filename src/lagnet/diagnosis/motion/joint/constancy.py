"""Does a parameter hold through each recording? e = −J x − τ J_p δ over windows, τ from −1 to 1 through a recording.

A cause of the catalogue has one value. What fades, warms up or runs down within every recording leaves a mean value
that the same effect explains, and a trend about it: with p = p̄ + δ τ a gain that falls from nominal has δ as large as
the change of its mean. One Gauss–Newton step from the fitted law gives δ, with the sandwich covariance of the windows'
scores. Source: White 1982.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.motion.joint.cases import windows_to_fit
from lagnet.diagnosis.motion.joint.fitting import HUBER, free_coordinates, robust_scale, sensitivities
from lagnet.diagnosis.motion.joint.intervals import NORMAL_95
from lagnet.diagnosis.motion.joint.joint_case import JointCase, sizes_of
from lagnet.diagnosis.motion.joint.refitting import groups_of
from lagnet.diagnosis.motion.problem import MotionProblem

CHANGES_WITHIN = "changes_within_recordings"  # rule: its value does not hold through a recording
LEAST_RIDGE = 1e-9


@dataclass(frozen=True)
class Trend:
    """Change of a parameter from the middle of recordings to their ends.

    Args:
        parameter: name in the law.
        share: |δ| over |p − p₀|, what the effect changes.
        least: the lower end of its 95 % interval.
    """

    parameter: str
    share: float
    least: float

    def is_more_than(self, share: float) -> bool:
        """Whether it is, and not by scatter alone."""
        return self.share > share and self.least > 0.0


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
    predicted, jacobian = sensitivities(data, coordinates, law)
    residual = predicted - data.series.q
    scale = robust_scale(residual, case.floor)
    weight = 1.0 / np.maximum(1.0, np.abs(residual) / (HUBER * scale))
    through = _through(problem, len(residual))
    changed = np.abs(coordinates.read(law) - coordinates.read(case.law)) / coordinates.sizes
    out = {}
    for effect in effects:
        own = [coordinates.groups.index(g) for g in groups_of(case, (effect,)) if g in coordinates.groups]
        if not own or not max(changed[own]) > 0.0:
            continue
        i = max(own, key=lambda k: changed[k])
        columns = np.column_stack([jacobian, jacobian[:, i] * through])
        rows = list(zip(data.windows.first, data.windows.last, strict=True))
        step, error = _last_step(columns, residual, weight, rows)
        name = coordinates.groups[i][0]
        out[effect] = Trend(name, abs(step) / changed[i], (abs(step) - NORMAL_95 * error) / changed[i])
    return out


def _through(problem: MotionProblem, count: int) -> np.ndarray:
    """Place of every sample in its recording, −1 at its begin and 1 at its end, shape (n,)."""
    out = np.zeros(count)
    for recording in {run.recording for run in problem.runs}:
        runs = [run for run in problem.runs if run.recording == recording]
        first, last = min(run.first for run in runs), max(run.last for run in runs)
        out[first : last + 1] = np.linspace(-1.0, 1.0, last - first + 1)
    return out


def _last_step(
    columns: np.ndarray, residual: np.ndarray, weight: np.ndarray, rows: list[tuple[int, int]]
) -> tuple[float, float]:
    """Gauss–Newton step of the last column, and its standard error over windows."""
    scores = np.array([columns[a : b + 1].T @ (weight[a : b + 1] * residual[a : b + 1]) for a, b in rows])
    normal = (columns * weight[:, None]).T @ columns
    ridge = LEAST_RIDGE * max(float(np.trace(normal)), 1e-30) / len(normal)
    inverse = np.linalg.inv(normal + ridge * np.eye(len(normal)))
    step = -inverse @ scores.sum(axis=0)
    centred = scores - scores.mean(axis=0)
    count = len(scores)
    covariance = inverse @ (centred.T @ centred) @ inverse * count / max(1, count - len(normal))
    return float(step[-1]), float(np.sqrt(max(covariance[-1, -1], 0.0)))
