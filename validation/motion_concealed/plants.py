"""Position-controlled arms that MuJoCo moves, with at most one cause hidden in servo, joint or bodies."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import load_description
from lagnet.servos.nominal import NominalServo
from lagnet.servos.servo_file import servo_of_values

DATA = Path(os.environ.get("LAGNET_DATA_DIR", Path(__file__).parents[3] / "shared" / "data"))
STEP, SAMPLE = 2.5e-4, 0.02  # [s] of the engine, of the recording
ENCODER = 2.0 * np.pi / 4096.0  # [rad]
RIGID = [0.9999, 0.9999, 0.001, 0.5, 2.0]  # solimp of dry friction, which else creeps
STOP = [2.0 * STEP, 1.0]  # solref of dry friction: MuJoCo's own 0.02 s make it viscous at low speed
SERVO = {"kp": 8.0, "kd": 0.3, "viscous": 0.15, "coulomb": 0.03, "rotor": 0.01}
STILL = 2e-3  # [rad/s] below which break-away friction acts
LISTED: dict[str, tuple[str, float, float]] = {  # effect → parameter, least and greatest value
    "command_delay": ("T", 0.02, 0.06),
    "dead_band": ("b", 0.02, 0.05),
    "gain_error": ("kp", 4.0, 6.5),
    "position_bias": ("delta", 0.02, 0.05),
    "coulomb_friction": ("Fc", 0.08, 0.2),
    "viscous_friction": ("Fv", 0.35, 0.7),
    "static_friction": ("Fs", 0.15, 0.3),
    "payload": ("m", 0.1, 0.25),
    "joint_spring": ("k", 0.5, 1.0),
}
UNLISTED: dict[str, tuple[str, float, float]] = {"torque_ripple": ("A", 0.1, 0.2)}
LAW_KEY = {"gain_error": "kp", "coulomb_friction": "coulomb", "viscous_friction": "viscous"}
LINK = """<body name="{name}" pos="0 0 {z}"><joint name="{name}" type="hinge" axis="0 1 0" range="-3 3"/>
<inertial pos="0 0 -0.08" mass="{mass}" diaginertia="4e-4 4e-4 5e-5"/>{inner}</body>"""
WRAP = '<mujoco model="{name}"><compiler angle="radian"/><worldbody>{inner}</worldbody></mujoco>'


@dataclass(frozen=True)
class Cause:
    """What a plant hides: an effect at a joint, with its true value."""

    effect: str
    joint: int
    parameter: str
    value: float


@dataclass(frozen=True)
class Plant:
    """A nominal robot with its servos, recordings of the real one, and what that hides."""

    name: str
    robot: Any
    servo: NominalServo
    recordings: tuple[Recording, ...]
    cause: Cause | None


def plant(seed: int, index: int, kind: str, effect: str | None, seconds: float, folder: Path) -> Plant:
    """One plant of a kind that hides an effect, or nothing.

    Args:
        seed, index: of all that is drawn.
        kind: pendulum, leg or so101.
        effect: a key of LISTED or UNLISTED.
        seconds: of each of three recordings.
        folder: for the nominal model's file.
    """
    rng = np.random.default_rng([seed, index])
    robot = load_description(_nominal_file(kind, folder))
    cause = None
    if effect is not None:
        parameter, low, high = (LISTED | UNLISTED)[effect]
        joint = robot.n_dof - 1 if kind != "so101" else int(rng.integers(1, 4))
        digits = 3 if effect == "command_delay" else 4  # whole steps of the engine
        cause = Cause(effect, joint, parameter, round(float(rng.uniform(low, high)), digits))
    recordings = tuple(_record(robot, cause, seconds, int(rng.integers(1 << 30)), i) for i in range(3))
    given = {joint: SERVO for joint in robot.joints}
    return Plant(
        f"{kind}_{index}", robot, servo_of_values(given, robot.joints, robot.armature, "file"), recordings, cause
    )


def _nominal_file(kind: str, folder: Path) -> Path:
    if kind == "so101":
        return DATA / "so101" / "so101.xml"
    inner = LINK.format(name="lower", z=-0.16 if kind == "leg" else 0, mass=0.25, inner="")
    if kind == "leg":
        inner = LINK.format(name="upper", z=0, mass=0.3, inner=inner)
    path = folder / f"{kind}.xml"
    path.write_text(WRAP.format(name=kind, inner=inner), encoding="utf-8")
    return path


def _record(robot: Any, cause: Cause | None, seconds: float, seed: int, index: int) -> Recording:
    model = _real_model(robot, cause)
    rng, time = np.random.default_rng(seed), np.arange(0.0, seconds, SAMPLE)
    command = _commands(rng, time, robot)
    data, q = mujoco.MjData(model), np.empty((time.size, robot.n_dof))
    places = [model.joint(name) for name in robot.joints]
    at = (np.array([j.qposadr[0] for j in places]), np.array([j.dofadr[0] for j in places]))
    data.qpos[at[0]] = command[0]
    late = round(cause.value / STEP) if cause is not None and cause.effect == "command_delay" else 0
    per = round(SAMPLE / STEP)
    for k in range(time.size):
        q[k] = data.qpos[at[0]]
        for i in range(per):
            asked = command[k].copy()
            if late and cause is not None:
                asked[cause.joint] = command[max(0, k * per + i - late) // per, cause.joint]
            _drive(model, data, at, asked, cause)
            mujoco.mj_step(model, data)
    return Recording(time, ENCODER * np.round(q / ENCODER), None, robot.joints, command=command, path=f"run_{index}")


def _commands(rng: np.random.Generator, time: np.ndarray, robot: Any) -> np.ndarray:
    """Eight seconds of steps, six of slow turns and six of a chirp in turn, within the joints' limits."""
    middle = np.array([0.5 * (low + high) for low, high in zip(*_limits(robot), strict=True)])
    reach = np.minimum(1.0, 0.4 * (_limits(robot)[1] - _limits(robot)[0]))
    steps = rng.uniform(-1.0, 1.0, (int(time[-1] / 2.0) + 1, robot.n_dof))[(time / 2.0).astype(int)]
    t, phase = (time % 20.0)[:, None], rng.uniform(0.5, 1.0, robot.n_dof)
    slow = 0.15 * np.abs((t + phase) % 3.0 - 1.5) + 0.5 * phase - 0.5  # [rad], 0.15 rad/s
    chirp = 0.6 * np.sin(2.0 * np.pi * (0.1 + 0.04 * t) * t) * phase
    return middle + reach * np.where(t < 8.0, steps, np.where(t < 14.0, slow, chirp))


def _limits(robot: Any) -> tuple[np.ndarray, np.ndarray]:
    return np.maximum(robot.position_lower, -3.0), np.minimum(robot.position_upper, 3.0)


def _real_model(robot: Any, cause: Cause | None) -> mujoco.MjModel:
    """The nominal bodies with the servos of SERVO and the cause."""
    spec = mujoco.MjSpec.from_file(str(robot.source))
    for part in (*spec.actuators, *spec.geoms, *spec.meshes):
        spec.delete(part)
    for joint, name in enumerate(robot.joints):
        law = SERVO | _changed(cause, joint)
        motor = spec.add_actuator(name=f"{name}_servo", target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        motor.gainprm[0], motor.biastype = law["kp"], mujoco.mjtBias.mjBIAS_AFFINE
        motor.biasprm[1], motor.biasprm[2] = -law["kp"], -law["kd"]
    if cause is not None and cause.effect == "payload":
        body = spec.joint(robot.joints[-1]).parent
        body.mass += cause.value  # where the link's own mass is: its load grows as a whole
    spec.option.timestep, spec.option.integrator = STEP, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    model = spec.compile()
    for joint, name in enumerate(robot.joints):
        law, dof = SERVO | _changed(cause, joint), model.joint(name).dofadr[0]
        model.dof_damping[dof], model.dof_frictionloss[dof] = law["viscous"], law["coulomb"]
        model.dof_armature[dof], model.dof_solimp[dof], model.dof_solref[dof] = law["rotor"], RIGID, STOP
        model.jnt_limited[model.joint(name).id] = 0
    return model


def _changed(cause: Cause | None, joint: int) -> Mapping[str, float]:
    if cause is None or cause.joint != joint or cause.effect not in LAW_KEY:
        return {}
    return {LAW_KEY[cause.effect]: cause.value}


def _drive(model: Any, data: Any, at: tuple[np.ndarray, np.ndarray], asked: np.ndarray, cause: Cause | None) -> None:
    """Commands of the servos, and what of the cause changes with the state."""
    if cause is not None:
        place, dof = at[0][cause.joint], at[1][cause.joint]
        q, v = data.qpos[place], data.qvel[dof]
        if cause.effect == "dead_band":
            error = asked[cause.joint] - q
            asked[cause.joint] = q + np.sign(error) * max(abs(error) - cause.value, 0.0)
        elif cause.effect == "position_bias":
            asked[cause.joint] -= cause.value
        elif cause.effect == "static_friction":
            model.dof_frictionloss[dof] = SERVO["coulomb"] + (cause.value if abs(v) < STILL else 0.0)
        elif cause.effect == "joint_spring":
            data.qfrc_applied[dof] = -cause.value * q
        elif cause.effect == "torque_ripple":
            data.qfrc_applied[dof] = cause.value * np.sin(8.0 * q)
    data.ctrl[:] = asked
