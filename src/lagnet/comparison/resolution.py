"""Which differences between parameter sets the recordings can resolve: base parameters with their intervals.

The error of the first set is Y_b δβ beside friction; δβ with its covariance by blocks says where each set stands. What
no motion shows (no base parameter) is told apart from what this motion did not show. Source: Gautier 1991.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.comparison.blocks import BESIDE, StretchErrors
from lagnet.recordings.conditioning.condition import Conditioned
from lagnet.recordings.conditioning.smoothing import low_pass
from lagnet.rigid_body.base_parameters import BaseParameters, base_parameters
from lagnet.rigid_body.robot import Robot

RESOLVED = 3.0  # standard errors between two sets
SAME = 1e-9  # of a base parameter's size: no difference
KEPT = 1e-7  # of the largest singular value: directions that the motion shows at all


@dataclass(frozen=True, eq=False)
class Resolution:
    """Base parameters of several sets against recordings.

    Args:
        names: combinations in words.
        values: shape (sets, r), base parameters of each set.
        estimate: shape (r,), what the recordings say; nan where the motion does not show it.
        error: shape (r,), its standard error; infinite where the motion does not show it.
        base: the combinations.
    """

    names: tuple[str, ...]
    values: np.ndarray
    estimate: np.ndarray
    error: np.ndarray
    base: BaseParameters

    @property
    def spread(self) -> np.ndarray:
        """Largest difference between two sets, shape (r,)."""
        return np.ptp(self.values, axis=0)

    @property
    def differing(self) -> np.ndarray:
        """Where sets differ at all, indices."""
        size = np.maximum(np.max(np.abs(self.values), axis=0), 1e-12)
        return np.flatnonzero(self.spread > SAME * size)

    @property
    def resolved(self) -> np.ndarray:
        """Of those, where the recordings tell two sets apart, indices."""
        return np.array([k for k in self.differing if self.spread[k] > RESOLVED * self.error[k]], dtype=int)

    @property
    def open(self) -> np.ndarray:
        """Of those, where they do not, indices."""
        return np.setdiff1d(self.differing, self.resolved)


def resolution(
    robots: Sequence[Robot], parts: Sequence[StretchErrors], conditioned: Conditioned, length: int
) -> Resolution:
    """Estimate the base parameters beside friction, with errors by blocks.

    Args:
        robots: the sets, of one kinematics; the first is the origin of the estimate.
        parts: errors of the same robots in the same order.
        conditioned: the recordings.
        length: samples of a block.
    """
    base = base_parameters(robots[0])
    scale = _noise(parts)
    shift, covariance = _fit(robots[0], base, parts, conditioned, length, scale)
    values = np.array([base.of(r.inertial_parameters()) for r in robots])
    error = np.sqrt(np.diagonal(covariance))
    estimate = np.where(np.isfinite(error), values[0] + shift, np.nan)
    return Resolution(base.describe(), values, estimate, error, base)


def _noise(parts: Sequence[StretchErrors]) -> np.ndarray:
    """Size of the smallest error of each joint, its weight in the fit, shape (dof,) [N m]."""
    power = np.array([np.sum(p.errors**2, axis=1) for p in parts]).sum(axis=0)
    count = sum(len(p.torque) for p in parts)
    return np.maximum(np.sqrt(power.min(axis=0) / count), 1e-12)


def _fit(
    robot: Robot,
    base: BaseParameters,
    parts: Sequence[StretchErrors],
    conditioned: Conditioned,
    length: int,
    scale: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Change of the base parameters (r,) and covariance (r, r) by the sandwich of block scores."""
    n_dof, size = robot.n_dof, base.rank + BESIDE * robot.n_dof
    gram, moment = np.zeros((size, size)), np.zeros(size)
    blocks: list[tuple[np.ndarray, np.ndarray]] = []
    for part in parts:
        s = part.stretch
        for start in range(0, len(part.torque), length):
            rows = slice(start, min(start + length, len(part.torque)))
            table = np.zeros((rows.stop - rows.start, n_dof, size))
            table[:, :, : base.rank] = _columns(robot, base, s, rows, conditioned)
            for j in range(n_dof):
                at = base.rank + BESIDE * j
                table[:, j, at : at + BESIDE] = part.beside[rows, j]
            flat = (table / scale[:, None]).reshape(-1, size)
            target = (part.errors[0, rows] / scale).ravel()
            blocks.append((flat.T @ flat, flat.T @ target))
            gram += blocks[-1][0]
            moment += blocks[-1][1]
    unit = np.sqrt(np.maximum(np.diag(gram), 1e-300))
    strength, axes = np.linalg.eigh(gram / np.outer(unit, unit))
    shown = strength > KEPT * strength[-1]
    inverse = (axes[:, shown] / strength[shown]) @ axes[:, shown].T
    x = inverse @ (moment / unit)
    scores = np.array([(m - g @ (x / unit)) / unit for g, m in blocks])
    freedom = len(blocks) / max(len(blocks) - 1, 1)
    covariance = inverse @ (scores.T @ scores) @ inverse * freedom
    unseen = np.sum(axes[:, ~shown] ** 2, axis=1) > 1e-3  # a parameter that lies in a direction without motion
    covariance[unseen, unseen] = np.inf
    k = base.rank
    return (x / unit)[:k], covariance[:k, :k] / np.outer(unit, unit)[:k, :k]


def _columns(robot: Robot, base: BaseParameters, s, rows: slice, conditioned: Conditioned) -> np.ndarray:
    """Base columns of some rows, low-passed as the torque is, shape (m, dof, r)."""
    table = base.reduce(robot.joint_torque_regressor(s.q[rows], s.v[rows], s.a[rows]))
    m = len(table)
    if m < 20:
        return table
    return low_pass(table.reshape(m, -1), conditioned.rate, conditioned.bandwidth).reshape(table.shape)
