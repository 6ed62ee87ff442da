"""An arm in MuJoCo with something hidden in it, driven by computed torque of the arm that hides nothing."""

from __future__ import annotations

import xml.etree.ElementTree as Tree
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from validation.another_simulator.hidden import UNLISTED, Hidden, Usual

STEP = 0.0005  # [s] of the simulation
CONTROL = 2  # steps between two torques
BAND, DAMPING, INTEGRAL = 4.0, 0.8, 1.5  # [Hz], of critical, [1/s]: of the controller
RUNAWAY = 50.0  # [rad/s] or [m/s]: a simulation that has come apart
FLEX, LOAD = "flex", "load"
Reference = Callable[[float], tuple[np.ndarray, np.ndarray, np.ndarray]]
"""time → q, v, a that are asked for, each of shape (dof,)."""


class CameApartError(RuntimeError):
    """The simulation ran away: the drawn numbers make no arm that moves."""


@dataclass(frozen=True)
class Written:
    """What an arm writes down: time (n,) [s], q, v and tau, each (n, dof)."""

    time: np.ndarray
    q: np.ndarray
    v: np.ndarray
    tau: np.ndarray


class MujocoArm:
    """A URDF in MuJoCo, with causes hidden in bodies and joints."""

    def __init__(self, urdf: str, hidden: Sequence[Hidden] = ()):
        spec = _read(urdf)
        self.names = tuple(joint.name for joint in spec.joints)
        self.hidden = tuple(hidden)
        for cause in self.hidden:
            joint = None if cause.joint is None else spec.joint(self.names[cause.joint])
            _built_in(spec, joint, cause, spec.joint(self.names[-1]).parent)
        self.model = spec.compile()
        joints = [self.model.joint(name) for name in self.names]
        self.at_q = np.array([j.qposadr[0] for j in joints])
        self.at_v = np.array([j.dofadr[0] for j in joints])
        self.data = mujoco.MjData(self.model)

    def torque(self, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        """Inverse dynamics of one state, shape (dof,); of an arm that hides nothing."""
        self.data.qpos[self.at_q], self.data.qvel[self.at_v], self.data.qacc[self.at_v] = q, v, a
        mujoco.mj_inverse(self.model, self.data)
        return self.data.qfrc_inverse[self.at_v].copy()

    def usual(self, reference: Reference, seconds: float) -> Usual:
        """What the motion asks of the arm."""
        q, v, a = (np.array(x) for x in zip(*(reference(t) for t in np.arange(0.0, seconds, 0.05)), strict=True))
        torque = np.array([self.torque(*state) for state in zip(q, v, a, strict=True)])
        rms = [np.sqrt(np.mean(x**2, axis=0)) for x in (torque, v, a)]
        unit = np.eye(len(self.names))
        still = self.torque(q.mean(axis=0), 0.0 * unit[0], 0.0 * unit[0])
        inertia = [self.torque(q.mean(axis=0), 0.0 * e, e)[i] - still[i] for i, e in enumerate(unit)]
        most, mass = np.quantile(np.abs(torque), 0.93, axis=0), float(self.model.body_mass.sum())
        return Usual(rms[0], most, rms[1], rms[2], q.std(axis=0), q.mean(axis=0), np.array(inertia), mass)

    def run(self, nominal: MujocoArm, reference: Reference, seconds: float, rate: float) -> Written:
        """Follows a motion; the controller knows the nominal arm alone.

        Raises:
            CameApartError: the simulation ran away.
        """
        data, n = self.data, len(self.names)
        mujoco.mj_resetData(self.model, data)
        data.qpos[self.at_q] = reference(0.0)[0]
        inertia = np.maximum(nominal.usual(reference, 1.0).inertia, 1e-3)
        stiff, damp = inertia * (2.0 * np.pi * BAND) ** 2, 2.0 * DAMPING * inertia * 2.0 * np.pi * BAND
        asked, summed, rows = np.zeros(n), np.zeros(n), []
        every = round(1.0 / (rate * STEP))
        for i in range(round(seconds / STEP)):
            now = i * STEP
            q, v = data.qpos[self.at_q].copy(), data.qvel[self.at_v].copy()
            if i % CONTROL == 0:
                target = reference(now)
                summed += (target[0] - q) * STEP * CONTROL
                asked = nominal.torque(*target) + stiff * (target[0] - q + INTEGRAL * summed) + damp * (target[1] - v)
            data.qfrc_applied[:] = 0.0
            data.qfrc_applied[self.at_v] = asked - self._lost(q, v)
            self._pushed(now / seconds)
            if i % every == 0:
                rows.append((now, q, v, asked.copy()))
            mujoco.mj_step(self.model, data)
            if not np.all(np.abs(data.qvel) < RUNAWAY):
                raise CameApartError(f"at {now:.2f} s")
        return Written(*(np.array(column) for column in zip(*rows, strict=True)))

    def _lost(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Torque that causes without a part of their own in MuJoCo take, shape (dof,)."""
        lost = np.zeros_like(q)
        for cause in self.hidden:
            if cause.effect in TERMS:
                j = cause.joint
                assert j is not None
                other = (j + int(cause.values["other"])) % q.size if "other" in cause.values else j
                lost[j] += TERMS[cause.effect](cause.values, (q[j], v[j]), (q[other], v[other]))
        return lost

    def _pushed(self, share: float) -> None:
        """A force on the last body from 35 to 60 % of the time."""
        for cause in self.hidden:
            if cause.effect == "contact_force" and 0.35 <= share < 0.6:
                body = int(self.model.jnt_bodyid[self.model.joint(self.names[-1]).id])
                force = np.array([cause.values[k] for k in "xyz"])
                mujoco.mj_applyFT(
                    self.model, self.data, force, np.zeros(3), self.data.xipos[body], body, self.data.qfrc_applied
                )


def _read(urdf: str) -> mujoco.MjSpec:
    root = Tree.fromstring(urdf)
    told = Tree.SubElement(Tree.SubElement(root, "mujoco"), "compiler")
    told.attrib.update(fusestatic="false", balanceinertia="true", boundmass="1e-6", boundinertia="1e-9")
    spec = mujoco.MjSpec.from_string(Tree.tostring(root, encoding="unicode"))
    spec.option.timestep, spec.option.integrator = STEP, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    for joint in spec.joints:
        joint.limited = False
    return spec


def _built_in(spec: Any, joint: Any, cause: Hidden, last: Any) -> None:
    """Gives the model what MuJoCo itself knows of a cause."""
    values = cause.values
    match cause.effect:
        case "viscous_friction":
            joint.damping = _first(joint.damping, values["Fv"])
        case "coulomb_friction":
            joint.frictionloss = values["Fc"]
        case "rotor_inertia":
            joint.armature = values["Ia"]
        case "joint_spring":
            joint.stiffness, joint.springref = _first(joint.stiffness, values["k"]), values["q0"]
        case "link_inertia":
            joint.parent.mass *= values["factor"]
            joint.parent.inertia = np.array(joint.parent.inertia) * values["factor"]
        case "payload":
            load = last.add_body(name=LOAD, pos=[values[k] for k in ("cx", "cy", "cz")])
            load.mass, load.inertia, load.explicitinertial = values["m"], np.full(3, 0.002 * values["m"]), True
        case "gravity_tilt":
            spec.option.gravity = _tilted(values["roll"], values["pitch"])
        case "joint_elasticity":
            joint.armature = values["rotor"]
            flex = joint.parent.add_joint(name=FLEX, type=joint.type, axis=joint.axis, pos=joint.pos)
            flex.stiffness = _first(flex.stiffness, values["k"])
            flex.damping = _first(flex.damping, 0.1 * np.sqrt(values["k"] * values["rotor"] / 0.3))


def _first(like: Any, value: float) -> Any:
    """The value, as the first coefficient of a polynomial where this version of MuJoCo has one."""
    return value if np.ndim(like) == 0 else np.array([value, *np.zeros(np.size(like) - 1)])


def _tilted(roll: float, pitch: float) -> np.ndarray:
    about_x = [[1, 0, 0], [0, np.cos(roll), -np.sin(roll)], [0, np.sin(roll), np.cos(roll)]]
    about_y = [[np.cos(pitch), 0, np.sin(pitch)], [0, 1, 0], [-np.sin(pitch), 0, np.cos(pitch)]]
    return np.array(about_y) @ np.array(about_x) @ [0.0, 0.0, -9.81]


TERMS: dict[str, Callable[..., float]] = {
    "asymmetric_friction": lambda p, own, other: (
        (p["plus"] if own[1] > 0 else p["minus"]) * np.tanh(own[1] / p["sharp"])
    ),
    "stribeck_friction": lambda p, own, other: (
        (p["Fc"] + p["more"] * np.exp(-abs(own[1]) / p["vs"])) * np.tanh(own[1] / p["sharp"])
    ),
    "quadratic_drag": lambda p, own, other: p["c"] * own[1] * abs(own[1]),
    "torque_ripple": lambda p, own, other: p["A"] * np.sin(p["N"] * own[0] + p["phase"]),
    "belt": lambda p, own, other: -p["size"] * np.tanh(3.0 * (other[0] - 0.5 * own[0] - p["slack"])),
    "friction_of_another_joint": lambda p, own, other: p["size"] * np.tanh(other[1] / p["sharp"]),
    "wear_along_the_path": lambda p, own, other: p["size"] * own[1] * np.exp(np.sin(2.3 * own[0])),
}
assert set(UNLISTED) <= set(TERMS)
