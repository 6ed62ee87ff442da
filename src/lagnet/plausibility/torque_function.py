"""A plain function τ(q, v, a) as a model: its terms are read from the function by asking at rest and without motion."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.types import MassMatrix, Trajectory


@dataclass(frozen=True, eq=False)
class TorqueFunction:
    """The calls of InverseDynamics, made from inverse dynamics alone.

    H(q) e_j = τ(q, 0, e_j) − τ(q, 0, 0), g(q) = τ(q, 0, 0), c(q, v) = τ(q, v, 0) − g(q): friction goes into c,
    where the checks find it. Take it off in the function, or write a class with `residual_torque`, to judge it apart.

    Args:
        function: takes q, v, a of shape (n, dof), returns torque of the same shape.
        joints: joint names.
        joint_types: 'revolute', 'continuous' or 'prismatic' of each joint, revolute where not given.
    """

    function: Callable[[Trajectory, Trajectory, Trajectory], Trajectory]
    joints: Sequence[str]
    joint_types: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if not self.joint_types:
            object.__setattr__(self, "joint_types", ("revolute",) * len(self.joints))

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        return len(self.joints)

    def inverse_dynamics(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """The function itself."""
        return np.asarray(self.function(q, v, a), dtype=float)

    def gravity_torque(self, q: Trajectory) -> Trajectory:
        """Torque at rest."""
        rest = np.zeros_like(q)
        return self.inverse_dynamics(q, rest, rest)

    def coriolis_torque(self, q: Trajectory, v: Trajectory) -> Trajectory:
        """What motion adds to the torque at rest."""
        return self.inverse_dynamics(q, v, np.zeros_like(q)) - self.gravity_torque(q)

    def mass_matrix(self, q: Trajectory) -> MassMatrix:
        """What unit accelerations add to the torque at rest, column by column."""
        rest, gravity = np.zeros_like(q), self.gravity_torque(q)
        columns = [self.inverse_dynamics(q, rest, np.broadcast_to(e, q.shape)) - gravity for e in np.eye(self.n_dof)]
        return np.stack(columns, axis=2)
