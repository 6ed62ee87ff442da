"""Which way gravity points at the base, told from all joints at once: arms hang from ceilings and stand out of walls.

So large a tilt is far from the law made linear about the level base. Here its direction is found first: beside an
offset, friction and a rotor at every joint and a body on the last link, which need not be there, by Gauss–Newton on the
sphere of directions, from several starts.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.effects.motion import Motion
from lagnet.effects.own_terms import beside_own_terms
from lagnet.rigid_body.inertia import BODY

DOWN = np.array([0.0, 0.0, -1.0])  # gravity in the level frame
STARTS = (DOWN, -DOWN, *np.eye(3)[:2], *-np.eye(3)[:2])
FAR = 0.35  # rad: less is near enough to the level base
LEFT = 0.25  # of what is left with the base level, joints weighed alike: a large tilt is what most of it comes from
WORTH = 0.01  # of the torque's power: with less left on a level base there is nothing to explain
STEPS = 12
SETTLED = 1e-4  # rad
RIDGE = 1e-9  # of a column's own power, for what the motion leaves open


def far_direction(weight: np.ndarray, fields: np.ndarray, inertia: np.ndarray, motion: Motion) -> np.ndarray | None:
    """Unit vector of gravity in the level frame, shape (3,); None where it is near DOWN, or explains too little.

    Args:
        weight: shape (n, dof, 3), torque per unit of that vector [N m].
        fields: shape (3, n, dof, 10), torque per unit of each component of that vector and parameter of a last body.
        inertia: shape (n, dof, 10), torque per unit of each parameter without gravity.
        motion: with the recorded torque.
    """
    table = np.concatenate([weight, inertia, *fields], axis=2)
    sums = _Sums(_beside_joint_terms(table, motion))
    level = sums.left(DOWN)
    if level < WORTH * motion.n_dof:
        return None
    best = min((sums.nearest(start) for start in STARTS), key=sums.left)
    far = np.arccos(np.clip(best @ DOWN, -1.0, 1.0)) > FAR
    return best if far and sums.left(best) < LEFT * level else None


@dataclass(frozen=True, eq=False)
class _Sums:
    """Products of all columns with each other, shape (44, 44): gravity 3, a body 10, its weights 30, the residual."""

    products: np.ndarray

    def left(self, direction: np.ndarray) -> float:
        """Power of what gravity along a direction and the best body there leave."""
        rest, body = self._at(direction)
        return self._fit(body, rest)[1]

    def nearest(self, direction: np.ndarray) -> np.ndarray:
        """The direction at the end of a descent."""
        for _ in range(STEPS):
            rest, body = self._at(direction)
            held = self._fit(body, rest)[0]
            across = np.linalg.svd(direction[None])[2][1:].T
            per_axis = np.concatenate(
                [np.eye(3), np.zeros((BODY, 3)), np.kron(np.eye(3), held[:, None]), np.zeros((1, 3))]
            )
            step, _ = self._fit(np.column_stack([per_axis @ across, body]), rest)
            moved = direction + across @ step[:2]
            direction, last = moved / np.linalg.norm(moved), direction
            if np.linalg.norm(direction - last) < SETTLED:
                break
        return direction

    def _at(self, direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What is left with gravity along a direction, and the columns of a body there, in terms of all columns."""
        rest = np.concatenate([DOWN - direction, np.zeros(4 * BODY), [1.0]])
        body = np.concatenate(
            [np.zeros((3, BODY)), np.eye(BODY), np.kron(direction[:, None], np.eye(BODY)), np.zeros((1, BODY))]
        )
        return rest, body

    def _fit(self, columns: np.ndarray, rest: np.ndarray) -> tuple[np.ndarray, float]:
        gram, moment = columns.T @ self.products @ columns, columns.T @ self.products @ rest
        size = np.sqrt(np.maximum(np.diag(gram), 1e-300))
        x = np.linalg.solve(gram / np.outer(size, size) + RIDGE * np.eye(size.size), moment / size) / size
        return x, float(rest @ self.products @ rest - 2.0 * x @ moment + x @ gram @ x)


def _beside_joint_terms(table: np.ndarray, motion: Motion) -> np.ndarray:
    """Mean products of the columns and the residual over each joint's torque, less an offset, friction and a rotor."""
    assert motion.recorded is not None
    products = np.zeros((table.shape[2] + 1,) * 2)
    for j in range(motion.n_dof):
        size = max(float(np.std(motion.recorded[:, j])), 1e-12)
        both = np.column_stack([table[:, j], motion.recorded[:, j] - motion.load[:, j]]) / size
        both = beside_own_terms(motion, j, both)
        products += both.T @ both / len(both)
    return products
