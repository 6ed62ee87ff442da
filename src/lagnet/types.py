"""Array aliases with named dimensions, and the calls that every dynamics model answers.

Dimensions: `n` samples (batch first), `dof` joints. Units are SI: rad, rad/s, rad/s², N m for revolute joints,
m, m/s, m/s², N for prismatic ones.
"""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

JointVector = Float[np.ndarray, " dof"]
Samples = Float[np.ndarray, " n"]
Trajectory = Float[np.ndarray, "n dof"]
MassMatrix = Float[np.ndarray, "n dof dof"]


@runtime_checkable
class InverseDynamics(Protocol):
    """URDFs, learned models and corrected models all answer these calls; NumPy in, NumPy out, batch first."""

    @property
    def joints(self) -> tuple[str, ...]:
        """Joint names in model order."""
        ...

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        ...

    def inverse_dynamics(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """Joint torque [N m] (force [N] on prismatic joints) that gives acceleration a at (q, v), shape (n, dof)."""
        ...

    def mass_matrix(self, q: Trajectory) -> MassMatrix:
        """Joint-space inertia M(q), shape (n, dof, dof)."""
        ...

    def coriolis_torque(self, q: Trajectory, v: Trajectory) -> Trajectory:
        """Centrifugal and Coriolis torques c(q, v) = C(q, v) v, shape (n, dof)."""
        ...

    def gravity_torque(self, q: Trajectory) -> Trajectory:
        """Torque that holds the arm still against gravity, shape (n, dof)."""
        ...
