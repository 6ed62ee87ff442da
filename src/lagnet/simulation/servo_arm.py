"""A small arm with position servos in PyBullet, one of whose servos hides physics from the diagnosis.

    M v' = M v + h (kp dead_band(u(t − T) − q − δ; b) − (kd + Fv) v − g) − h f,   |f| ≤ Fc, f against v' or v' = 0

with the commands late by whole steps. The engine moves the bodies; servos and friction are solved here, apart from
`lagnet.rollout`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import Robot
from lagnet.simulation.pybullet_arm import PyBulletArm
from lagnet.types import JointVector, Trajectory

STEP, SAMPLE = 0.001, 0.02  # [s] of the engine, of the recording
ENCODER = 2.0 * np.pi / 4096.0  # [rad]
SWEEPS = 20
SERVO = {"kp": 8.0, "kd": 0.4, "viscous": 0.2, "coulomb": 0.03, "rotor": 0.01}  # as the simulation has it
RANGES: dict[str, tuple[str, str, float, float]] = {  # effect → parameter, key of the servo, least and greatest value
    "command_delay": ("T", "delay", 0.03, 0.06),
    "coulomb_friction": ("Fc", "coulomb", 0.12, 0.25),
    "gain_error": ("kp", "kp", 4.0, 6.0),
    "dead_band": ("b", "dead_band", 0.04, 0.07),
    "rotor_inertia": ("Ia", "rotor", 0.03, 0.05),
}
LINK = """<link name="{name}"><inertial><origin xyz="0 0 -0.08"/><mass value="{mass}"/>
<inertia ixx="4e-4" ixy="0" ixz="0" iyy="4e-4" iyz="0" izz="5e-5"/></inertial></link>"""
JOINT = """<joint name="{name}" type="revolute"><origin xyz="0 0 {z}"/><parent link="{parent}"/><child link="{child}"/>
<axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="100" velocity="100"/></joint>"""


@dataclass(frozen=True)
class HiddenEffect:
    """An effect of the motion route's catalogue at one joint, with its true parameter."""

    effect: str
    joint: int
    key: str
    parameter: str
    value: float


def write_desk_arm(path: Path) -> Path:
    """The URDF of two links of 16 cm that hang from a table."""
    links = [LINK.format(name=name, mass=mass) for name, mass in (("upper", 0.3), ("fore", 0.25))]
    joints = [
        JOINT.format(name="shoulder", z=0, parent="base", child="upper"),
        JOINT.format(name="elbow", z=-0.16, parent="upper", child="fore"),
    ]
    path.write_text('<robot name="desk_arm"><link name="base"/>' + "".join(links + joints) + "</robot>", "utf-8")
    return path


def write_servos(path: Path) -> Path:
    """SERVO.toml of the nominal servos."""
    path.write_text("[all]\n" + "".join(f"{k} = {v:g}\n" for k, v in SERVO.items()), encoding="utf-8")
    return path


def draw_hidden(n_joints: int, seed: int) -> tuple[HiddenEffect, ...]:
    """One effect at every joint, all of different kinds."""
    rng = np.random.default_rng(seed)
    names = rng.permutation(sorted(RANGES))[:n_joints]
    rows = [(str(name), joint, *RANGES[str(name)]) for joint, name in enumerate(names)]
    return tuple(HiddenEffect(e, j, key, p, round(float(rng.uniform(a, b)), 4)) for e, j, p, key, a, b in rows)


def truth_of(hidden: Sequence[HiddenEffect], joints: Sequence[str]) -> dict:
    """What was hidden, as plain data: the envelope that a diagnosis must not open."""
    effects = [{"effect": e.effect, "joint": joints[e.joint], "parameters": {e.parameter: e.value}} for e in hidden]
    return {"schema": "lagnet-truth/1", "effects": effects}


def record_motion(robot: Robot, hidden: Sequence[HiddenEffect], seconds: float, seed: int) -> Recording:
    """Steps and chirps by command, recorded at 50 Hz by encoders of 4096 steps."""
    servos = [SERVO | {e.key: e.value for e in hidden if e.joint == j} for j in range(robot.n_dof)]
    time, command = _commands(robot.n_dof, seconds, seed)
    q = _driven(robot, servos, command)
    return Recording(time, ENCODER * np.round(q / ENCODER), None, robot.joints, command=command)


def _commands(n_joints: int, seconds: float, seed: int) -> tuple[np.ndarray, Trajectory]:
    rng, time = np.random.default_rng(seed), np.arange(0.0, seconds, SAMPLE)
    steps = rng.uniform(-1.2, 1.2, (int(seconds / 2.0) + 1, n_joints))[(time / 2.0).astype(int)]
    phase = rng.uniform(0.0, 2.0 * np.pi, n_joints)
    chirp = 0.6 * np.sin(2.0 * np.pi * (0.1 + 0.04 * (time % 20.0)) * (time % 20.0))[:, None] * np.cos(phase)
    return time, np.where((time % 20.0 < 10.0)[:, None], steps, chirp)


def _driven(robot: Robot, servos: Sequence[Mapping[str, float]], command: Trajectory) -> Trajectory:
    """Positions at every sample."""
    part = {k: np.array([s.get(k, 0.0) for s in servos]) for k in (*SERVO, "delay", "dead_band")}
    per, late = round(SAMPLE / STEP), np.round(part["delay"] / STEP).astype(int)
    q, joints = np.empty_like(command), np.arange(robot.n_dof)
    with PyBulletArm(robot, STEP) as arm:
        arm.put(command[0], np.zeros(robot.n_dof))
        for k in range(len(command)):
            q[k] = arm.state()[0]
            for i in range(per):
                sample = np.maximum(0, k * per + i - late) // per
                _advance(arm, part, command[sample, joints])
    return q


def _advance(arm: PyBulletArm, part: Mapping[str, np.ndarray], u: JointVector) -> None:
    """One step of the engine under servos and friction, friction solved with the speeds that it leads to."""
    q, v = arm.state()
    bodies, bias = arm.mass_matrix(q), arm.bias_torque(q, v)
    error = u - q
    error = np.sign(error) * np.maximum(np.abs(error) - part["dead_band"], 0.0)
    damping = part["kd"] + part["viscous"]
    mass = bodies + np.diag(part["rotor"] + STEP * damping)
    free = (bodies + np.diag(part["rotor"])) @ v + STEP * (part["kp"] * error - bias)
    new, most = v.copy(), STEP * part["coulomb"]
    for _ in range(SWEEPS):
        for j in range(q.size):
            rest = free[j] - mass[j] @ new + mass[j, j] * new[j]
            new[j] = np.sign(rest) * max(abs(rest) - most[j], 0.0) / mass[j, j]
    arm.advance(bodies @ (new - v) / STEP + bias)
