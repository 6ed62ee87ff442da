"""What an engineer fits in a minute: least squares over all inertial parameters, friction, offset and rotor.

Shares with the product its conditioning of recordings alone; the fit is written out here.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lagnet.diagnosis.problem.problem import Problem, Segment

ROUNDS = 4  # of weighting joints by their errors
RIDGE = 1e-8  # of scaled columns


def local_columns(problem: Problem, piece: Segment, joint: int) -> np.ndarray:
    """Viscous and dry friction, offset and rotor of one joint, shape (n, 4)."""
    v = piece.v[:, joint]
    return np.column_stack([v, np.tanh(v / problem.slow[joint]), np.ones_like(v), piece.a[:, joint]])


class LeastSquares:
    """Weighted least squares over 10 parameters a link, shared by all joints, and four a joint."""

    def __init__(self, robot: Any, problem: Problem) -> None:
        self.robot, self.problem, self.n = robot, problem, problem.n_dof
        rows = [self._rows(j) for j in range(self.n)]
        weights = np.array([1.0 / max(float(np.std(y)), 1e-12) for _, y, _ in rows])
        for _ in range(ROUNDS):
            self.x = self._solve(rows, weights)
            errors = [np.std((y - a @ self._of(j))[k]) for j, (a, y, k) in enumerate(rows)]
            weights = 1.0 / np.maximum(errors, 1e-12)

    def torque(self, piece: Segment) -> np.ndarray:
        """Torque along a piece, shape (n, dof)."""
        regressor = self.robot.joint_torque_regressor(piece.q, piece.v, piece.a)
        columns = [np.column_stack([regressor[:, j], local_columns(self.problem, piece, j)]) for j in range(self.n)]
        return piece.load + np.column_stack([a @ self._of(j) for j, a in enumerate(columns)])

    def _places(self, joint: int) -> np.ndarray:
        bodies = 10 * self.n
        return np.r_[0:bodies, bodies + 4 * joint : bodies + 4 * joint + 4]

    def _of(self, joint: int) -> np.ndarray:
        return self.x[self._places(joint)]

    def _rows(self, joint: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        columns, target, counts = [], [], []
        for piece in self.problem.fit:
            regressor = self.robot.joint_torque_regressor(piece.q, piece.v, piece.a)[:, joint]
            own = np.column_stack([regressor, local_columns(self.problem, piece, joint)])
            columns.append(self.problem.reduce(piece, own))
            target.append(self.problem.residual(piece)[:, joint])
            counts.append(piece.counts[:, joint])
        return np.vstack(columns), np.concatenate(target), np.concatenate(counts)

    def _solve(self, rows: list, weights: np.ndarray) -> np.ndarray:
        size = 14 * self.n
        gram, moment = np.zeros((size, size)), np.zeros(size)
        for joint, (a, y, keep) in enumerate(rows):
            own = self._places(joint)
            gram[np.ix_(own, own)] += a[keep].T @ a[keep] * weights[joint] ** 2
            moment[own] += a[keep].T @ y[keep] * weights[joint] ** 2
        scale = np.sqrt(np.diag(gram))
        used = scale > 1e-9 * scale.max()
        inner = gram[np.ix_(used, used)] / scale[used][:, None] / scale[used] + RIDGE * np.eye(int(used.sum()))
        x = np.zeros(size)
        x[used] = np.linalg.solve(inner, moment[used] / scale[used]) / scale[used]
        return x
