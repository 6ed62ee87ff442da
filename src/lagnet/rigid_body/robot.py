"""A fixed-base arm of rigid bodies: inverse and forward dynamics, their terms, and regressors, over many samples."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, final

import numpy as np

from lagnet.rigid_body import batches, pinocchio_models
from lagnet.rigid_body.body_tree import TreeBody, tree_of
from lagnet.rigid_body.descriptions.description import NONE_HELD, Description
from lagnet.rigid_body.descriptions.mass_checks import joints_without_mass, require_mass
from lagnet.rigid_body.descriptions.reading import read_description
from lagnet.rigid_body.descriptions.writing import bare_urdf_text, mjcf_text, urdf_text, write_text
from lagnet.rigid_body.inertia import parameters_of_body
from lagnet.rigid_body.placeholders import are_placeholders
from lagnet.rigid_body.untyped_pinocchio import Model, pin
from lagnet.types import JointVector, MassMatrix, Samples, Trajectory


def load_description(spec: str | Path, held: Mapping[str, float] = NONE_HELD) -> Robot:
    """The rigid bodies of a named robot, a URDF file or an MJCF file.

    The grippers of named robots are held still at zero (`named_robots.HELD_JOINTS`); those of a file are kept as given.

    Args:
        spec: a name of example-robot-data (`ur5`, `panda`, …), or the path of a .urdf or .xml file.
        held: joints that no recording tells of, e.g. fingers, and where they are held still [rad or m].

    Raises:
        RobotError: unknown name, unreadable file, or not a fixed-base arm of one-degree-of-freedom joints.
    """
    return Robot(read_description(spec, held))


@final
class Robot:
    """Rigid-body dynamics of a fixed-base arm; arrays of shape (n_samples, n_dof) in and out, SI units.

    Instances never change; `with_…` return changed copies. Calls may run in threads side by side.

    Attributes:
        joints: joint names in model order.
        joint_types: 'revolute', 'continuous' or 'prismatic'; a continuous joint's position is one angle.
        links: name of the body behind each joint, into which links behind fixed joints are merged.
        parents: index of the joint each joint sits on, -1 for the base.
        position_lower, position_upper, velocity_limit, effort_limit: shape (dof,), inf where unlimited.
        armature: shape (dof,), inertia of the motors felt at the joints [kg m²]; MJCF alone can declare it.
        gravity: shape (3,), in the frame of the base [m/s²].
        kind: 'urdf', 'mjcf' or 'named_robot'.
        source: the name or path that was asked for; sha256: checksum of the file behind it.
        link_inertials: (link name, ten parameters in the link's frame) as a URDF gives them, before merging.
        warnings: what the reader noticed and survived.
    """

    def __init__(self, description: Description):
        self._description, self._model = description, description.model
        model = self._model
        self._weightless = pinocchio_models.with_gravity(model, np.zeros(3))
        self.joints: tuple[str, ...] = tuple(model.names[1:])
        self.joint_types, self.links = description.joint_types, description.links
        self.parents: tuple[int, ...] = tuple(int(model.parents[i]) - 1 for i in range(1, model.njoints))
        self.position_lower = pinocchio_models.limit(model.lowerPositionLimit)
        self.position_upper = pinocchio_models.limit(model.upperPositionLimit)
        self.velocity_limit = pinocchio_models.limit(model.upperVelocityLimit)
        self.effort_limit = pinocchio_models.limit(model.upperEffortLimit)
        self.armature = pinocchio_models.frozen(model.armature)
        self.gravity = pinocchio_models.frozen(model.gravity.linear)
        self.kind, self.source, self.sha256 = description.kind, description.source, description.file.sha256
        self.link_inertials, self.warnings = description.link_inertials, description.warnings

    def __repr__(self) -> str:
        return f"Robot({self.source!r}, {self.n_dof} joints: {', '.join(self.joints)})"

    def __deepcopy__(self, memo: dict[int, Any]) -> Robot:
        return self._with(self._model.copy())

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        return self._model.nv

    def inverse_dynamics(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """Joint torque [N m] (force [N] on prismatic joints) that gives acceleration a at (q, v), shape (n, dof)."""
        return batches.inverse_dynamics(self._model, *self._batch(q=q, v=v, a=a))

    def torque_derivatives(self, q: Trajectory, v: Trajectory, a: Trajectory) -> np.ndarray:
        """∂τ/∂q, ∂τ/∂v and ∂τ/∂a = M, shape (3, n, dof, dof): torque of a row's joint per motion of a column's joint.

        Source: Carpentier and Mansard, Analytical derivatives of rigid body dynamics algorithms, RSS 2018.
        """
        return batches.torque_derivatives(self._model, *self._batch(q=q, v=v, a=a))

    def forward_dynamics(self, q: Trajectory, v: Trajectory, tau: Trajectory) -> Trajectory:
        """Acceleration [rad/s²] that torque tau gives at (q, v), shape (n, dof).

        Raises:
            RobotError: a joint with nothing that has mass behind it.
        """
        found = batches.forward_dynamics(self._model, *self._batch(q=q, v=v, tau=tau))
        if not np.isfinite(found).all():
            self.require_mass()
        return found

    @property
    def has_mass(self) -> bool:
        """Whether any link has mass: False for kinematics alone."""
        return bool(np.any(self.inertial_parameters()[:, 0]))

    @property
    def knows_masses(self) -> bool:
        """Whether masses can be no placeholders: False without any, and where all but one at most are the same."""
        return not are_placeholders(self.inertial_parameters()[:, 0])

    @property
    def can_move(self) -> bool:
        """Whether something behind every joint has mass, so that torque moves it."""
        return not joints_without_mass(self._model)

    def require_mass(self) -> None:
        """Nothing for an arm that torque can move.

        Raises:
            RobotError: a joint with nothing that has mass behind it, as in a file of kinematics alone.
        """
        require_mass(self._model, self.source)

    def mass_matrix(self, q: Trajectory) -> MassMatrix:
        """Joint-space inertia M(q), shape (n, dof, dof)."""
        return batches.mass_matrix(self._model, *self._batch(q=q))

    def coriolis_matrix(self, q: Trajectory, v: Trajectory) -> MassMatrix:
        """C(q, v) with C v the centrifugal and Coriolis torque and Ṁ = C + Cᵀ, shape (n, dof, dof)."""
        return batches.coriolis_matrix(self._model, *self._batch(q=q, v=v))

    def coriolis_torque(self, q: Trajectory, v: Trajectory) -> Trajectory:
        """Centrifugal and Coriolis torques c(q, v) = C(q, v) v, shape (n, dof)."""
        return batches.coriolis_torque(self._weightless, *self._batch(q=q, v=v))

    def gravity_torque(self, q: Trajectory) -> Trajectory:
        """Torque that holds the arm still against gravity, shape (n, dof)."""
        return batches.gravity_torque(self._model, *self._batch(q=q))

    def kinetic_energy(self, q: Trajectory, v: Trajectory) -> Samples:
        """½ vᵀ M(q) v, shape (n,), [J]."""
        return batches.energy(pin.computeKineticEnergy, self._model, *self._batch(q=q, v=v))

    def potential_energy(self, q: Trajectory) -> Samples:
        """Energy in the field of gravity, zero for masses at the height of the base's origin, shape (n,), [J]."""
        return batches.energy(pin.computePotentialEnergy, self._model, *self._batch(q=q))

    def joint_torque_regressor(self, q: Trajectory, v: Trajectory, a: Trajectory) -> np.ndarray:
        """Torque per unit of each inertial parameter, shape (n, dof, 10 dof).

        The ten parameters of joint k's body are columns 10 k to 10 k + 9, about the origin of the joint's frame and in
        its axes: m [kg], m c_x, m c_y, m c_z [kg m], I_xx, I_xy, I_yy, I_xz, I_yz, I_zz [kg m²]. With `armature`,
        inverse dynamics = regressor · parameters + armature a. A sample takes 80 dof² bytes: see `regressor_chunks`.
        """
        return batches.regressor(self._model, slice(None), *self._batch(q=q, v=v, a=a))

    def regressor_chunks(
        self, q: Trajectory, v: Trajectory, a: Trajectory, chunk: int = 4096
    ) -> Iterator[tuple[slice, np.ndarray]]:
        """The joint torque regressor in pieces, so that any number of samples fits: (rows, (≤ chunk, dof, 10 dof))."""
        q, v, a = self._batch(q=q, v=v, a=a)
        if chunk < 1:
            raise ValueError(f"chunk is {chunk}, expected at least 1")
        for start in range(0, len(q), chunk):
            rows = slice(start, min(start + chunk, len(q)))
            yield rows, batches.regressor(self._model, slice(None), q[rows], v[rows], a[rows])

    def link_regressor(self, joint: int, q: Trajectory, v: Trajectory, a: Trajectory) -> np.ndarray:
        """Torque per unit of each inertial parameter of the body behind one joint, shape (n, dof, 10)."""
        k = self._joint(joint)
        return batches.regressor(self._model, slice(10 * k, 10 * k + 10), *self._batch(q=q, v=v, a=a))

    def weight_regressor(self, joint: int, q: Trajectory) -> np.ndarray:
        """Holding torque per unit of gravity along each axis and each parameter of one body, shape (3, n, dof, 10)."""
        return batches.weight_regressor(self._model, self._joint(joint), *self._batch(q=q))

    def gravity_regressor(self, q: Trajectory) -> np.ndarray:
        """Holding torque per unit of each component of the gravity vector, shape (n, dof, 3), [N m s²/m]."""
        (q,) = self._batch(q=q)
        fields = [batches.gravity_torque(pinocchio_models.with_gravity(self._model, unit), q) for unit in np.eye(3)]
        return np.stack(fields, axis=2)

    def wrench_regressor(self, q: Trajectory, joint: int = -1) -> np.ndarray:
        """Torque that the actuators must add per unit of a wrench that the surroundings put on the arm, (n, dof, 6).

        Columns: force x, y, z [N], moment x, y, z [N m], in the axes of the base, acting at the tip (joint -1) or at
        the origin of a joint's frame. It is -Jᵀ: a hand that is pushed down (F_z < 0) asks for more lift.
        """
        frame = pinocchio_models.tip_frame(self._model) if joint == -1 else self._joint_frame(joint)
        return -batches.tip_jacobian(self._model, frame, *self._batch(q=q)).transpose(0, 2, 1)

    def orientation(self, q: Trajectory, joint: int = -1) -> np.ndarray:
        """Axes of a joint's frame as columns in the axes of the base, shape (n, 3, 3)."""
        return batches.orientation(self._model, self._joint(joint) + 1, *self._batch(q=q))

    def skeleton(self, q: JointVector) -> np.ndarray:
        """Points to draw the arm in one pose: base, origin of each joint, tip; shape (dof + 2, 3), [m]."""
        data = pinocchio_models.placed(self._model, q)
        origins = [data.oMi[i].translation for i in range(1, self._model.njoints)]
        return np.array([np.zeros(3), *origins, data.oMf[pinocchio_models.tip_frame(self._model)].translation])

    def joint_axes(self, q: JointVector) -> np.ndarray:
        """Unit axis of each joint in one pose, in the axes of the base, shape (dof, 3)."""
        data = pinocchio_models.placed(self._model, q)
        jacobian = data.J.reshape(6, self.n_dof)
        axes = [jacobian[0:3, i] if t == "prismatic" else jacobian[3:6, i] for i, t in enumerate(self.joint_types)]
        return np.array(axes)

    def inertial_parameters(self) -> np.ndarray:
        """Ten parameters of the body behind each joint, in the order of the regressor, shape (dof, 10)."""
        return pinocchio_models.inertial_parameters(self._model)

    def with_inertial_parameters(self, parameters: np.ndarray) -> Robot:
        """The same arm with other bodies; parameters of shape (dof, 10) in the order of the regressor."""
        return self._with(pinocchio_models.with_inertial_parameters(self._model, parameters))

    def with_gravity(self, gravity: np.ndarray) -> Robot:
        """The same arm mounted otherwise; gravity of shape (3,) in the frame of the base [m/s²]."""
        return self._with(pinocchio_models.with_gravity(self._model, gravity))

    def with_armature(self, armature: np.ndarray) -> Robot:
        """The same arm with other rotors; armature of shape (dof,), inertia felt at each joint [kg m²]."""
        return self._with(pinocchio_models.with_armature(self._model, armature))

    def body_tree(self) -> tuple[TreeBody, ...]:
        """The moving bodies with their joints as plain numbers, from the base outwards."""
        return tree_of(self._description, self)

    def with_payload(self, mass: float, com: np.ndarray, inertia: np.ndarray, joint: int = -1) -> Robot:
        """The same arm with a body fixed to the last link.

        Args:
            mass: [kg]; negative to take a body off.
            com: shape (3,), centre of mass in the frame of the joint that carries it [m].
            inertia: shape (3, 3), about the payload's own centre of mass, in the axes of that frame [kg m²].
            joint: index of the joint that carries it, the last by default.
        """
        com, inertia = np.asarray(com, dtype=float), np.asarray(inertia, dtype=float)
        if com.shape != (3,) or inertia.shape != (3, 3):
            raise ValueError(f"com and inertia have shapes {com.shape}, {inertia.shape}, expected (3,), (3, 3)")
        parameters = self.inertial_parameters()
        parameters[self._joint(joint)] += parameters_of_body(mass, com, inertia)
        return self.with_inertial_parameters(parameters)

    def write_urdf(self, path: str | Path) -> None:
        """Writes the URDF the arm came from with its present inertials; joints, limits, names and shapes stay.

        Raises:
            RobotError: the arm has rotor inertias, which a URDF cannot hold.
        """
        write_text(Path(path), urdf_text(self._description))

    def write_bare_urdf(self, path: str | Path) -> None:
        """Writes a URDF of the moving bodies alone, without shapes and meshes, e.g. for a simulator without a window.

        Raises:
            RobotError: the arm has rotor inertias, which a URDF cannot hold.
        """
        write_text(Path(path), bare_urdf_text(self._description))

    def write_mjcf(self, path: str | Path) -> None:
        """Writes the arm as plain MJCF: bodies, joints with limits, inertials, gravity."""
        write_text(Path(path), mjcf_text(self._description))

    def _with(self, model: Model) -> Robot:
        return Robot(replace(self._description, model=model))

    def _batch(self, **arrays: np.ndarray) -> list[np.ndarray]:
        """Arrays as float64 of one shape (n, dof)."""
        return batches.as_rows(self.n_dof, **arrays)

    def _joint(self, joint: int) -> int:
        if not -self.n_dof <= joint < self.n_dof:
            raise ValueError(f"joint is {joint}, expected 0 to {self.n_dof - 1} ({', '.join(self.joints)})")
        return joint % self.n_dof

    def _joint_frame(self, joint: int) -> int:
        return self._model.getFrameId(self.joints[self._joint(joint)], pin.FrameType.JOINT)
