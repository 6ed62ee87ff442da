"""A fixed-base arm of rigid bodies: inverse and forward dynamics, their terms, and regressors, over many samples."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, final

import numpy as np

from lagnet.errors import RobotError
from lagnet.rigid_body import batches
from lagnet.rigid_body.body_tree import TreeBody, tree_of
from lagnet.rigid_body.descriptions.description import NONE_HELD, Description
from lagnet.rigid_body.descriptions.mjcf import read_mjcf
from lagnet.rigid_body.descriptions.named_robots import HELD_JOINTS, named_robot_path, named_robots
from lagnet.rigid_body.descriptions.urdf import read_urdf
from lagnet.rigid_body.descriptions.writing import bare_urdf_text, mjcf_text, urdf_text, write_text
from lagnet.rigid_body.descriptions.xml_files import read_xml
from lagnet.rigid_body.inertia import parameters_of_body, tensor_about_com, tensor_about_origin
from lagnet.rigid_body.untyped_pinocchio import Data, Inertia, Model, pin
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
    path, text = Path(spec), str(spec)
    looks_like_a_path = isinstance(spec, Path) or path.suffix != "" or len(path.parts) > 1
    if not looks_like_a_path and (text in named_robots() or not path.exists()):  # a folder "ur5" does not hide the UR-5
        file = read_xml(named_robot_path(text))
        return Robot(read_urdf(file, "named_robot", text, {**dict.fromkeys(HELD_JOINTS.get(text, ()), 0.0), **held}))
    if path.suffix.lower() == ".xacro":
        raise RobotError("is a xacro file", where=text, next_step="run xacro on it first")
    file = read_xml(path)
    return Robot(read_mjcf(file, held) if file.root().tag == "mujoco" else read_urdf(file, held=held))


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
        self._weightless = _with_gravity(model, np.zeros(3))
        self.joints: tuple[str, ...] = tuple(model.names[1:])
        self.joint_types, self.links = description.joint_types, description.links
        self.parents: tuple[int, ...] = tuple(int(model.parents[i]) - 1 for i in range(1, model.njoints))
        self.position_lower = _limit(model.lowerPositionLimit)
        self.position_upper = _limit(model.upperPositionLimit)
        self.velocity_limit = _limit(model.upperVelocityLimit)
        self.effort_limit = _limit(model.upperEffortLimit)
        self.armature = _frozen(model.armature)
        self.gravity = _frozen(model.gravity.linear)
        self.kind, self.source, self.sha256 = description.kind, description.source, description.file.sha256
        self.link_inertials, self.warnings = description.link_inertials, description.warnings

    def __repr__(self) -> str:
        return f"Robot({self.source!r}, {self.n_dof} joints: {', '.join(self.joints)})"

    def __deepcopy__(self, memo: dict[int, Any]) -> Robot:
        return Robot(replace(self._description, model=self._model.copy()))

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        return self._model.nv

    def inverse_dynamics(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """Joint torque [N m] (force [N] on prismatic joints) that gives acceleration a at (q, v), shape (n, dof)."""
        return batches.inverse_dynamics(self._model, *self._batch(q=q, v=v, a=a))

    def forward_dynamics(self, q: Trajectory, v: Trajectory, tau: Trajectory) -> Trajectory:
        """Acceleration [rad/s²] that torque tau gives at (q, v), shape (n, dof)."""
        return batches.forward_dynamics(self._model, *self._batch(q=q, v=v, tau=tau))

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

    def gravity_regressor(self, q: Trajectory) -> np.ndarray:
        """Holding torque per unit of each component of the gravity vector, shape (n, dof, 3), [N m s²/m]."""
        (q,) = self._batch(q=q)
        fields = [batches.gravity_torque(_with_gravity(self._model, unit), q) for unit in np.eye(3)]
        return np.stack(fields, axis=2)

    def wrench_regressor(self, q: Trajectory, joint: int = -1) -> np.ndarray:
        """Torque that the actuators must add per unit of a wrench that the surroundings put on the arm, (n, dof, 6).

        Columns: force x, y, z [N], moment x, y, z [N m], in the axes of the base, acting at the tip (joint -1) or at
        the origin of a joint's frame. It is -Jᵀ: a hand that is pushed down (F_z < 0) asks for more lift.
        """
        frame = self._tip_frame() if joint == -1 else self._joint_frame(joint)
        return -batches.tip_jacobian(self._model, frame, *self._batch(q=q)).transpose(0, 2, 1)

    def orientation(self, q: Trajectory, joint: int = -1) -> np.ndarray:
        """Axes of a joint's frame as columns in the axes of the base, shape (n, 3, 3)."""
        return batches.orientation(self._model, self._joint(joint) + 1, *self._batch(q=q))

    def skeleton(self, q: JointVector) -> np.ndarray:
        """Points to draw the arm in one pose: base, origin of each joint, tip; shape (dof + 2, 3), [m]."""
        data = self._placed(q)
        origins = [data.oMi[i].translation for i in range(1, self._model.njoints)]
        return np.array([np.zeros(3), *origins, data.oMf[self._tip_frame()].translation])

    def joint_axes(self, q: JointVector) -> np.ndarray:
        """Unit axis of each joint in one pose, in the axes of the base, shape (dof, 3)."""
        data = self._placed(q)
        jacobian = data.J.reshape(6, self.n_dof)
        axes = [jacobian[0:3, i] if t == "prismatic" else jacobian[3:6, i] for i, t in enumerate(self.joint_types)]
        return np.array(axes)

    def inertial_parameters(self) -> np.ndarray:
        """Ten parameters of the body behind each joint, in the order of the regressor, shape (dof, 10)."""
        return np.array([_parameters(self._model.inertias[i]) for i in range(1, self._model.njoints)])

    def with_inertial_parameters(self, parameters: np.ndarray) -> Robot:
        """The same arm with other bodies; parameters of shape (dof, 10) in the order of the regressor."""
        parameters = np.asarray(parameters, dtype=float)
        if parameters.shape != (self.n_dof, 10):
            raise ValueError(f"parameters have shape {parameters.shape}, expected ({self.n_dof}, 10)")
        model = self._model.copy()
        for i, row in enumerate(parameters):
            model.inertias[i + 1] = _inertia(row)
        return Robot(replace(self._description, model=model))

    def with_gravity(self, gravity: np.ndarray) -> Robot:
        """The same arm mounted otherwise; gravity of shape (3,) in the frame of the base [m/s²]."""
        gravity = np.asarray(gravity, dtype=float)
        if gravity.shape != (3,):
            raise ValueError(f"gravity has shape {gravity.shape}, expected (3,)")
        return Robot(replace(self._description, model=_with_gravity(self._model, gravity)))

    def with_armature(self, armature: np.ndarray) -> Robot:
        """The same arm with other rotors; armature of shape (dof,), inertia felt at each joint [kg m²]."""
        armature = np.asarray(armature, dtype=float)
        if armature.shape != (self.n_dof,):
            raise ValueError(f"armature has shape {armature.shape}, expected ({self.n_dof},)")
        model = self._model.copy()
        model.armature = armature
        return Robot(replace(self._description, model=model))

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

    def _batch(self, **arrays: np.ndarray) -> list[np.ndarray]:
        """Arrays as float64 of one shape (n, dof)."""
        found = {name: np.ascontiguousarray(array, dtype=np.float64) for name, array in arrays.items()}
        n = len(next(iter(found.values()))) if next(iter(found.values())).ndim else 0
        for name, array in found.items():
            if array.shape != (n, self.n_dof):
                expected = f"(n_samples, {self.n_dof})" if array.ndim != 2 else f"({n}, {self.n_dof})"
                raise ValueError(f"{name} has shape {array.shape}, expected {expected}: one row a sample")
        return list(found.values())

    def _joint(self, joint: int) -> int:
        if not -self.n_dof <= joint < self.n_dof:
            raise ValueError(f"joint is {joint}, expected 0 to {self.n_dof - 1} ({', '.join(self.joints)})")
        return joint % self.n_dof

    def _placed(self, q: JointVector) -> Data:
        q = np.asarray(q, dtype=float)
        if q.shape != (self.n_dof,):
            raise ValueError(f"q has shape {q.shape}, expected ({self.n_dof},): one pose")
        data = self._model.createData()
        pin.computeJointJacobians(self._model, data, q)
        pin.updateFramePlacements(self._model, data)
        return data

    def _joint_frame(self, joint: int) -> int:
        return self._model.getFrameId(self.joints[self._joint(joint)], pin.FrameType.JOINT)

    def _tip_frame(self) -> int:
        """The frame on the last joint's body that lies farthest from it: a flange or tool frame where there is one."""
        last = self._model.njoints - 1
        own = [i for i, frame in enumerate(self._model.frames) if frame.parentJoint == last]
        return max(own, key=lambda i: round(float(np.linalg.norm(self._model.frames[i].placement.translation)), 9))


def _limit(values: np.ndarray) -> np.ndarray:
    values = np.array(values, dtype=float)
    values[np.abs(values) > 1e100] *= np.inf
    return _frozen(values)


def _frozen(values: np.ndarray) -> np.ndarray:
    values = np.array(values, dtype=float)
    values.setflags(write=False)
    return values


def _with_gravity(model: Model, gravity: np.ndarray) -> Model:
    model = model.copy()
    model.gravity.linear = np.asarray(gravity, dtype=float)
    return model


def _parameters(body: Inertia) -> np.ndarray:
    return parameters_of_body(body.mass, np.array(body.lever), np.array(body.inertia))


def _inertia(row: np.ndarray) -> Inertia:
    """A body from ten parameters.

    Raises:
        ValueError: first moment without mass, which no body has and Pinocchio cannot hold.
    """
    if row[0] == 0.0:
        if row[1:4].any():
            raise ValueError("a body of zero mass has a first moment; give it a mass")
        return pin.Inertia(0.0, np.zeros(3), tensor_about_origin(row))
    return pin.Inertia(float(row[0]), row[1:4] / row[0], tensor_about_com(row))
