"""A servo arm that MuJoCo moves: its actuators, its dry friction, and a motor of its own where it is apart."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from validation.motion_concealed.causes import (
    DAMPING,
    YIELDING,
    Cause,
    dry_friction,
    error_felt,
    law_with,
    torque_beside,
)

STEP = 2.5e-4  # [s] of the engine
RIGID = [0.9999, 0.9999, 0.001, 0.5, 2.0]  # solimp of dry friction, which else creeps, and of stops
STOP = [2.0 * STEP, 1.0]  # solref of dry friction: MuJoCo's own 0.02 s make it viscous at low speed
BALL = 0.004  # [m] radius of what touches a table
RUBBING = 0.2  # friction of a table
TWIST = "_twist"  # ending of the joint between a motor and its link


@dataclass(frozen=True)
class Table:
    """A level plane: height of the point that touches it [m], the joint that moves it, and where it is there [m]."""

    height: float
    joint: int
    point: tuple[float, float, float]


class MujocoPlant:
    """The arm with its servos; encoders as recorded.

    Args:
        robot: the nominal one; its file is what MuJoCo reads.
        law: of every servo.
        cause: what is hidden.
        table: what a point of the arm may touch.
    """

    def __init__(self, robot: Any, law: dict[str, float], cause: Cause | None, table: Table | None = None):
        self.law, self.cause = law, cause
        self.model = _model(robot, law, cause, table)
        self.data = mujoco.MjData(self.model)
        places = [self.model.joint(name) for name in robot.joints]
        self.at, self.dof = np.array([j.qposadr[0] for j in places]), np.array([j.dofadr[0] for j in places])
        self.twist = None
        if cause is not None and cause.effect in YIELDING:
            self.twist = self.model.joint(robot.joints[cause.joint] + TWIST)

    def start(self, q: np.ndarray) -> None:
        """At rest, motors at positions of shape (dof,)."""
        self.data.qpos[self.at] = q

    def seen(self) -> np.ndarray:
        """What the encoders show, shape (dof,) [rad]."""
        q = self.data.qpos[self.at].copy()
        if self.twist is not None and self.cause is not None and self.cause.side == "link":
            q[self.cause.joint] += self.data.qpos[self.twist.qposadr[0]]
        return q

    def advance(self, asked: np.ndarray, at: float, time: float) -> None:
        """One step under commands of shape (dof,); at: share of the recording, time: since its start [s]."""
        ctrl = asked.copy()
        if self.cause is not None:
            self._hide(self.cause, ctrl, at, time)
        self.data.ctrl[:] = ctrl
        mujoco.mj_step(self.model, self.data)

    def _hide(self, cause: Cause, ctrl: np.ndarray, at: float, time: float) -> None:
        j, dof = cause.joint, self.dof[cause.joint]
        q, v = float(self.data.qpos[self.at[j]]), float(self.data.qvel[dof])
        if self.twist is None:
            ctrl[j] = q + error_felt(cause, float(ctrl[j]), q, at)
            self.data.qfrc_applied[dof] = torque_beside(cause, q, time)
            if cause.effect == "static_friction":
                self.model.dof_frictionloss[dof] = dry_friction(cause, self.law, j, v)
            return
        if cause.side == "link":
            q += float(self.data.qpos[self.twist.qposadr[0]])
            v += float(self.data.qvel[self.twist.dofadr[0]])
        self.data.qfrc_applied[dof] = self.law["kp"] * (ctrl[j] - q) - self.law["kd"] * v


def _model(robot: Any, law: dict[str, float], cause: Cause | None, table: Table | None = None) -> mujoco.MjModel:
    """The nominal bodies with their servos and the cause."""
    spec = mujoco.MjSpec.from_file(str(robot.source))
    for part in (*spec.actuators, *spec.geoms, *spec.meshes):
        spec.delete(part)
    apart = cause.joint if cause is not None and cause.effect in YIELDING else None
    for joint, name in enumerate(robot.joints):
        gains = law_with(law, cause, joint)
        motor = spec.add_actuator(name=f"{name}_servo", target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        if joint != apart:  # else its torque is computed at the encoder's side
            motor.gainprm[0], motor.biastype = gains["kp"], mujoco.mjtBias.mjBIAS_AFFINE
            motor.biasprm[1], motor.biasprm[2] = -gains["kp"], -gains["kd"]
        else:
            motor.gainprm[0] = 0.0
    if cause is not None and cause.effect == "payload":
        spec.joint(robot.joints[-1]).parent.mass += cause.value  # where the link's own mass is
    if cause is not None and apart is not None:
        body, joint = spec.joint(robot.joints[apart]).parent, spec.joint(robot.joints[apart])
        twist = body.add_joint(name=joint.name + TWIST, type=joint.type, axis=joint.axis, pos=joint.pos)
        twist.armature = 0.0  # of a default class of the file
    for name in robot.joints:  # before it is compiled: regularisation of friction goes by the inertia of each joint
        spec.joint(name).armature = law["rotor"]
    if table is not None:
        _lay(spec, robot.joints[table.joint], table)
    spec.option.timestep, spec.option.integrator = STEP, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    model = spec.compile()
    model.jnt_limited[:] = 0
    for joint, name in enumerate(robot.joints):
        gains, dof = law_with(law, cause, joint), model.joint(name).dofadr[0]
        model.dof_damping[dof], model.dof_frictionloss[dof] = gains["viscous"], gains["coulomb"]
        model.dof_solimp[dof], model.dof_solref[dof] = RIGID, STOP
    if cause is not None and apart is not None:
        _join(model, model.joint(robot.joints[apart] + TWIST), model.joint(robot.joints[apart]), cause)
    return model


def _lay(spec: mujoco.MjSpec, joint: str, table: Table) -> None:
    """A plane, and a small ball at the point that touches it; no other pair touches."""
    seen = {"contype": 1, "conaffinity": 1, "friction": [RUBBING, 0.0, 0.0], "solref": STOP, "solimp": RIGID}
    at = [0.0, 0.0, table.height - BALL]
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[2.0, 2.0, 0.1], pos=at, **seen)
    size = [BALL, 0.0, 0.0]
    spec.joint(joint).parent.add_geom(
        type=mujoco.mjtGeom.mjGEOM_SPHERE, size=size, pos=list(table.point), mass=0.0, **seen
    )


def _join(model: mujoco.MjModel, twist: Any, motor: Any, cause: Cause) -> None:
    """Spring or play between a motor and its link."""
    dof = twist.dofadr[0]
    model.dof_frictionloss[dof], model.dof_damping[dof], model.jnt_stiffness[twist.id] = 0.0, 0.0, 0.0
    if cause.effect == "joint_elasticity":
        model.jnt_stiffness[twist.id] = cause.value
        model.qpos_spring[twist.qposadr[0]] = 0.0
        model.dof_damping[dof] = spring_damping(cause.value, float(model.dof_armature[motor.dofadr[0]]))
        return
    model.jnt_limited[twist.id] = 1
    model.jnt_range[twist.id] = [-cause.value, cause.value]
    model.jnt_solref[twist.id], model.jnt_solimp[twist.id] = STOP, RIGID


def spring_damping(stiffness: float, rotor: float) -> float:
    """D of a spring between a motor and its link [N m s/rad]."""
    return 2.0 * DAMPING * float(np.sqrt(stiffness * rotor))
