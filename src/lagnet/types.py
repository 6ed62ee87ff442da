"""Array aliases with named dimensions, and the calls that models of a robot answer: torques, regressors, bodies.

Dimensions: `n` samples (batch first), `dof` joints. Units are SI: rad, rad/s, rad/s², N m for revolute joints,
m, m/s, m/s², N for prismatic ones.
"""

from __future__ import annotations

from typing import Any, Protocol, TypeGuard, runtime_checkable

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


@runtime_checkable
class RigidBodyModel(InverseDynamics, Protocol):
    """A model whose torque is linear in the inertial parameters of its links, τ = Y(q, v, a) π, under any gravity.

    Robots have these calls, and serial chains learned from torque.
    """

    @property
    def gravity(self) -> np.ndarray:
        """Acceleration of gravity in the frame of the base, shape (3,) [m/s²]."""
        ...

    def joint_torque_regressor(self, q: Trajectory, v: Trajectory, a: Trajectory) -> np.ndarray:
        """Y(q, v, a), torque per unit of each inertial parameter, ten columns a link, shape (n, dof, 10 dof)."""
        ...

    def link_regressor(self, joint: int, q: Trajectory, v: Trajectory, a: Trajectory) -> np.ndarray:
        """The columns of Y for the link behind one joint, shape (n, dof, 10)."""
        ...

    def weight_regressor(self, joint: int, q: Trajectory) -> np.ndarray:
        """Holding torque per unit of gravity along each axis and each parameter of one link, shape (3, n, dof, 10)."""
        ...

    def gravity_regressor(self, q: Trajectory) -> np.ndarray:
        """∂τ/∂g, holding torque per unit of each component of gravity, shape (n, dof, 3) [N m s²/m]."""
        ...

    def with_gravity(self, gravity: np.ndarray) -> RigidBodyModel:
        """The same arm under another gravity, shape (3,) [m/s²] in the frame of the base."""
        ...


@runtime_checkable
class RobotModel(RigidBodyModel, Protocol):
    """Rigid bodies from a robot description: their parameters can be changed, and their joints have frames."""

    def inertial_parameters(self) -> np.ndarray:
        """π: m [kg], m c [kg m], I about the joint's origin [kg m²] of each link, shape (dof, 10)."""
        ...

    def with_inertial_parameters(self, parameters: np.ndarray) -> RobotModel:
        """The same arm with other inertial parameters, shape (dof, 10)."""
        ...

    def with_gravity(self, gravity: np.ndarray) -> RobotModel:
        """The same arm under another gravity, shape (3,) [m/s²] in the frame of the base."""
        ...

    def orientation(self, q: Trajectory, joint: int = -1) -> np.ndarray:
        """Axes of a joint's frame as columns in the axes of the base, shape (n, 3, 3)."""
        ...

    def wrench_regressor(self, q: Trajectory, joint: int = -1) -> np.ndarray:
        """−Jᵀ, torque per unit of a wrench (force, moment) on the arm, shape (n, dof, 6)."""
        ...


def has_regressor(model: object) -> TypeGuard[RigidBodyModel]:
    """Whether a model answers the calls of `RigidBodyModel`; a corrected model does if its nominal model does."""
    return hasattr(model, "joint_torque_regressor")


def is_robot_model(model: object) -> TypeGuard[RobotModel]:
    """Whether a model answers the calls of `RobotModel`; a corrected model does if its nominal model does."""
    return hasattr(model, "with_inertial_parameters")


def inertial_parameters_of(model: Any) -> np.ndarray:
    """π of every link of a model with bodies, shape (dof, 10): a call of robots, a value of learned chains."""
    found = model.inertial_parameters
    return np.array(found() if callable(found) else found, dtype=float)


def has_mass(model: object) -> bool:
    """Whether any link of a model has mass; True for a model that does not say, as one without links."""
    return bool(getattr(model, "has_mass", True))


def knows_masses(model: object) -> bool:
    """Whether the masses of a model's links can be no placeholders, which say nothing of the unit of torque.

    True for a model that does not say.
    """
    return bool(getattr(model, "knows_masses", True))


def joint_types_of(model: object, n_dof: int) -> tuple[str, ...]:
    """'revolute', 'continuous' or 'prismatic' of each joint; revolute for a model that does not say."""
    return tuple(getattr(model, "joint_types", ("revolute",) * n_dof))
