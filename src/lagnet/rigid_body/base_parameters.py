"""Which combinations of inertial parameters a motion can show at all: numerically minimal (base) parameters.

Some parameters move no joint's torque and others only together; the regressor then has dependent columns. A QR
factorisation with column pivoting at random states finds a largest set of independent columns and how the others
lean on them. Source: Gautier 1991.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import qr, solve_triangular

from lagnet.rigid_body.inertia import PARAMETER_NAMES
from lagnet.rigid_body.robot import Robot

# Of the largest pivot, columns scaled to one: rounding leaves 1e-15, angles rounded in a URDF 1e-10, physics 0.3.
RANK = 1e-7
EMPTY = 1e-11  # of the largest column: what is smaller is a column of rounding errors
NEGLIGIBLE = 1e-9  # coefficients below are rounding


@dataclass(frozen=True, eq=False)
class BaseParameters:
    """The identifiable combinations β = B π of an arm's inertial parameters.

    Args:
        combinations: B, shape (r, 10 dof); B is the unit matrix on the independent columns.
        independent: shape (r,), indices of the parameters whose columns span the regressor.
        dependent: shape (10 dof - r,), the others.
        joints: joint names, for reading.
    """

    combinations: np.ndarray
    independent: np.ndarray
    dependent: np.ndarray
    joints: tuple[str, ...]

    @property
    def rank(self) -> int:
        """Number of base parameters."""
        return len(self.independent)

    @property
    def unidentifiable(self) -> np.ndarray:
        """Parameters that no motion shows, alone or combined, as indices."""
        return np.flatnonzero(~np.any(self.combinations, axis=0))

    def of(self, parameters: np.ndarray) -> np.ndarray:
        """Base parameters β, shape (r,), of inertial parameters (dof, 10)."""
        return self.combinations @ np.asarray(parameters, dtype=float).ravel()

    def reduce(self, regressor: np.ndarray) -> np.ndarray:
        """Columns of the regressor (…, 10 dof) that multiply β, shape (…, r)."""
        return regressor[..., self.independent]

    def nearest(self, base: np.ndarray, prior: np.ndarray) -> np.ndarray:
        """The inertial parameters (dof, 10) with these base parameters that change the prior (dof, 10) least."""
        prior = np.asarray(prior, dtype=float)
        change = np.linalg.pinv(self.combinations) @ (np.asarray(base, dtype=float) - self.of(prior))
        return prior + change.reshape(prior.shape)

    def describe(self) -> tuple[str, ...]:
        """Each combination in words, e.g. "I_zz(joint 0) + 1 I_yy(joint 1)"."""
        return tuple(self._text(row, int(lead)) for row, lead in zip(self.combinations, self.independent, strict=True))

    def _text(self, row: np.ndarray, lead: int) -> str:
        text = self._name(lead)
        for k in np.flatnonzero(row):
            if k != lead:
                text += f" {'+' if row[k] > 0 else '-'} {abs(row[k]):.4g} {self._name(int(k))}"
        return text

    def _name(self, index: int) -> str:
        return f"{PARAMETER_NAMES[index % 10]}({self.joints[index // 10]})"


def base_parameters(robot: Robot, seed: int = 0) -> BaseParameters:
    """The base parameters of an arm under its own gravity, from random states.

    Args:
        robot: the arm; its inertias do not matter.
        seed: of the random states; the rank does not depend on it.
    """
    regressor = _random_regressor(robot, seed)
    scale = np.linalg.norm(regressor, axis=0)
    scale[scale < EMPTY * scale.max()] = np.inf  # must not be blown up to one
    found: Any = qr(regressor / scale, mode="r", pivoting=True)
    upper, order = np.asarray(found[0])[: regressor.shape[1]], np.asarray(found[1])
    pivots = np.abs(np.diag(upper))
    rank = int(np.sum(pivots > RANK * pivots[0]))
    lean = solve_triangular(upper[:rank, :rank], upper[:rank, rank:])
    with np.errstate(invalid="ignore"):
        lean = np.where(np.isinf(scale[order[rank:]]), 0.0, lean * scale[order[rank:]] / scale[order[:rank], None])
    lean[np.abs(lean) < NEGLIGIBLE] = 0.0
    combinations = np.zeros((rank, regressor.shape[1]))
    combinations[np.arange(rank), order[:rank]] = 1.0
    combinations[:, order[rank:]] = lean
    return BaseParameters(combinations, order[:rank], order[rank:], robot.joints)


def _random_regressor(robot: Robot, seed: int) -> np.ndarray:
    generator = np.random.default_rng(seed)
    n = 20 + 10 * robot.n_dof  # dof rows each: at least twice the columns
    q = generator.uniform(-np.pi, np.pi, (n, robot.n_dof))
    v, a = generator.normal(0.0, 1.0, (2, n, robot.n_dof)) * 3.0
    return robot.joint_torque_regressor(q, v, a).reshape(-1, 10 * robot.n_dof)
