"""Which differences between parameter sets the recordings can resolve: base parameters, rotors and friction.

The error of the first set is Y_b δβ + rotors and friction; δβ with its covariance by blocks says where each set stands.
A rotor whose torque some base parameters give as well (that of a first, upright joint) is counted with them. What
no motion shows (no base parameter) is told apart from what this motion did not show. Source: Gautier 1991.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.comparison.blocks import BESIDE, StretchErrors
from lagnet.comparison.differences import RESOLVED
from lagnet.recordings.conditioning.condition import Conditioned
from lagnet.recordings.conditioning.smoothing import low_pass
from lagnet.rigid_body.base_parameters import BaseParameters, base_parameters
from lagnet.rigid_body.robot import Robot

SAME = 1e-9  # of a parameter's size: no difference
KEPT = 1e-7  # of the largest singular value: directions that the motion shows at all
FOLDED = 1e-6  # of a rotor's torque: what base parameters leave of it where they give it as well
KINDS: tuple[str, ...] = ("viscous friction", "dry friction", "rotor inertia")
UNITS = {"m": "kg", "mc": "kg m", "I": "kg m²"} | dict(zip(KINDS, ("N m s/rad", "N m", "kg m²"), strict=True))


@dataclass(frozen=True, eq=False)
class Resolution:
    """Base parameters of several sets against recordings, then friction and rotors of the joints.

    Args:
        names: combinations in words.
        values: shape (sets, r), parameters of each set.
        estimate: shape (r,), what the recordings say; nan where the motion does not show it.
        error: shape (r,), its standard error; infinite where the motion does not show it.
        base: the combinations.
        beside: kind and joint of each parameter after those of the base.
    """

    names: tuple[str, ...]
    values: np.ndarray
    estimate: np.ndarray
    error: np.ndarray
    base: BaseParameters
    beside: tuple[tuple[str, int], ...] = ()

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

    def unit(self, k: int) -> str:
        """Unit of a parameter; a combination has that of its first term."""
        if k >= self.base.rank:
            return UNITS[self.beside[k - self.base.rank][0]]
        return UNITS[self.names[k].split("(")[0].split("_")[0]]


def resolution(
    robots: Sequence[Robot],
    parts: Sequence[StretchErrors],
    conditioned: Conditioned,
    length: int,
    friction: np.ndarray,
) -> Resolution:
    """Estimate base parameters, rotors and friction, with errors by blocks.

    Args:
        robots: the sets, of one kinematics; the first is the origin of the estimate.
        parts: errors of the same robots in the same order.
        conditioned: the recordings.
        length: samples of a block.
        friction: shape (sets, dof, 2), viscous and dry friction that each set declares.
    """
    base = base_parameters(robots[0])
    folded, rotors = folded_rotors(robots[0], base)
    table = _Table(robots[0], base, rotors, conditioned)
    shift, covariance = _fit(table, parts, length, _noise(parts))
    armature = np.array([r.armature for r in robots])
    values = np.array([base.of(r.inertial_parameters()) for r in robots]) + armature @ folded
    values = np.concatenate([values, friction[:, :, 0], friction[:, :, 1], armature[:, rotors]], axis=1)
    origin = values[0].copy()
    origin[base.rank : base.rank + 2 * robots[0].n_dof] = 0.0  # the errors hold all of the friction
    error = np.sqrt(np.diagonal(covariance))
    estimate = np.where(np.isfinite(error), origin + shift, np.nan)
    every = range(robots[0].n_dof)
    beside = tuple((kind, j) for kind, js in zip(KINDS, (every, every, rotors), strict=True) for j in js)
    names = base.describe() + tuple(f"{kind}({robots[0].joints[j]})" for kind, j in beside)
    return Resolution(names, values, estimate, error, base, beside)


def folded_rotors(robot: Robot, base: BaseParameters) -> tuple[np.ndarray, list[int]]:
    """Base parameters that give a rotor's torque, shape (dof, rank), and joints whose rotor none give."""
    q, v, a = np.random.default_rng(0).uniform(-1.5, 1.5, (3, 20 + 10 * robot.n_dof, robot.n_dof))
    table = base.reduce(robot.joint_torque_regressor(q, v, a)).reshape(-1, base.rank)
    torque = (a[:, :, None] * np.eye(robot.n_dof)).reshape(-1, robot.n_dof)
    size = np.linalg.norm(table, axis=0)
    x = np.linalg.lstsq(table / size, torque, rcond=None)[0]
    left = np.linalg.norm(torque - table / size @ x, axis=0) / np.linalg.norm(torque, axis=0)
    own = [j for j in range(robot.n_dof) if left[j] > FOLDED]
    folded = (x / size[:, None]).T
    folded[own] = 0.0
    return folded, own


def _noise(parts: Sequence[StretchErrors]) -> np.ndarray:
    """Size of the smallest error of each joint, its weight in the fit, shape (dof,) [N m]."""
    power = np.array([np.sum(p.errors**2, axis=1) for p in parts]).sum(axis=0)
    count = sum(len(p.torque) for p in parts)
    return np.maximum(np.sqrt(power.min(axis=0) / count), 1e-12)


@dataclass(frozen=True, eq=False)
class _Table:
    """The columns of the fit: base parameters; viscous, dry friction of each joint; rotors; offsets."""

    robot: Robot
    base: BaseParameters
    rotors: list[int]
    conditioned: Conditioned

    @property
    def size(self) -> int:
        return self.kept + self.robot.n_dof

    @property
    def kept(self) -> int:
        """Columns whose parameter a set holds; the offsets come after them."""
        return self.base.rank + 2 * self.robot.n_dof + len(self.rotors)

    def rows(self, part: StretchErrors, rows: slice) -> np.ndarray:
        """Shape (m, dof, size), low-passed as the torque is."""
        s, n, rank = part.stretch, self.robot.n_dof, self.base.rank
        moved = self.base.reduce(self.robot.joint_torque_regressor(s.q[rows], s.v[rows], s.a[rows]))
        spun = s.a[rows][:, :, None] * np.eye(n)[:, self.rotors]
        both = np.concatenate([moved, spun], axis=2)
        if len(both) >= 20:
            flat = low_pass(both.reshape(len(both), -1), self.conditioned.rate, self.conditioned.bandwidth)
            both = flat.reshape(both.shape)
        out = np.zeros((len(both), n, self.size))
        out[:, :, :rank], out[:, :, rank + 2 * n : self.kept] = both[:, :, :rank], both[:, :, rank:]
        for j in range(n):
            at = [self.kept + j, rank + j, rank + n + j]
            assert len(at) == BESIDE
            out[:, j, at] = part.beside[rows, j]
        return out


def _fit(
    table: _Table, parts: Sequence[StretchErrors], length: int, scale: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Change of the kept parameters (k,) and covariance (k, k) by the sandwich of block scores."""
    gram, moment = np.zeros((table.size, table.size)), np.zeros(table.size)
    blocks: list[tuple[np.ndarray, np.ndarray]] = []
    for part in parts:
        for start in range(0, len(part.torque), length):
            rows = slice(start, min(start + length, len(part.torque)))
            flat = (table.rows(part, rows) / scale[:, None]).reshape(-1, table.size)
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
    k = table.kept
    return (x / unit)[:k], covariance[:k, :k] / np.outer(unit, unit)[:k, :k]
