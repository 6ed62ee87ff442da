"""A robot with the servos that drive it: it answers for torques, and rolls out commands."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, final

import numpy as np

from lagnet.errors import ModelError
from lagnet.files import finite_json, write_whole
from lagnet.models.corrected.folder import MOST_BYTES, write_description
from lagnet.rigid_body.kinematic_tree import KinematicTree, kinematic_tree
from lagnet.rollout.surface import BODY, FRICTION, HARDNESS, SURFACE
from lagnet.rollout.whole_arm import roll_out_arm
from lagnet.servos.parameters import (
    COULOMB,
    INDEX,
    LAW,
    NAMES,
    NO_LIMIT,
    OFFSET,
    QUADRATIC,
    ROTOR,
    SPRING,
    SPRING_REST,
    VISCOUS,
)
from lagnet.types import JointVector, MassMatrix, Samples, Trajectory

FORMAT = 1
FILE = "servo.json"
SLOW = 0.02  # [rad/s] over which dry friction changes its side where torque is asked for sample by sample
STEP = 0.004  # [s] of a rollout at most


@final
@dataclass(frozen=True, eq=False)
class ServoDrivenModel:
    """Rigid bodies and one servo law a joint.

    Args:
        nominal: the robot whose bodies are driven.
        laws: shape (dof, len(LAW)), see `lagnet.servos.parameters`; `rotor` stands for the robot's armature.
        scale_is_set: for each joint whether its torques are known in N m or only in proportion to kp.
        voltage: nominal supply [V], 0 where none was recorded.
        surface: shape (len(SURFACE),), the level surface that the arm may touch, None where there is none; torques that
            are asked for sample by sample are those of the free arm.
        source, sha256: what it was read from, "" if nothing.
    """

    nominal: Any
    laws: np.ndarray
    scale_is_set: tuple[bool, ...]
    voltage: float = 0.0
    surface: np.ndarray | None = None
    source: str = ""
    sha256: str = ""
    kind: str = field(default="corrected", init=False)

    @property
    def joints(self) -> tuple[str, ...]:
        """Joint names in model order."""
        return tuple(self.nominal.joints)

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        return self.nominal.n_dof

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name in {"nominal", "laws"}:
            raise AttributeError(name)
        return getattr(self.nominal, name)  # limits, joint types, skeleton

    @property
    def tree(self) -> KinematicTree:
        """Bodies with the rotors of the servos."""
        return replace(kinematic_tree(self.nominal), armature=self.laws[:, ROTOR])

    def rollout(
        self,
        command: Trajectory,
        time: Samples,
        q0: JointVector,
        *,
        v0: JointVector | None = None,
        enabled: Trajectory | None = None,
        voltage: Trajectory | None = None,
        gain: float = 1.0,
        step: float = STEP,
    ) -> Trajectory:
        """Positions that the commands alone lead to, shape (n, dof) [rad or m].

        Args:
            command: shape (n, dof), held from each sample to the next; time: shape (n,) [s].
            q0: shape (dof,), where the arm starts; v0: its speed there, at rest where None.
            enabled: shape (n, dof), 1 where the drive gives torque; always where None.
            voltage: shape (n, dof) [V], for servos whose torque goes with it.
            gain: the controller's gains over those of the laws, as where another kp is written to the servo.
            step: longest step of integration [s].

        Raises:
            ValueError: arrays of other shapes.
        """
        command, time = np.asarray(command, dtype=float), np.asarray(time, dtype=float)
        if command.shape != (time.size, self.n_dof) or np.shape(q0) != (self.n_dof,):
            shapes = f"command {command.shape}, time {time.shape}, q0 {np.shape(q0)}"
            raise ValueError(f"shapes are {shapes}, expected (n, {self.n_dof}), (n,), ({self.n_dof},)")
        ratio = None if voltage is None or not self.voltage else np.asarray(voltage, dtype=float) / self.voltage
        gains = np.full(command.shape, gain)
        signals = {"ratio": ratio, "enabled": enabled, "gain": gains, "v0": v0, "surface": self.surface, "step": step}
        return roll_out_arm(self.tree, self.laws, time, command, np.asarray(q0, dtype=float), **signals)

    def inverse_dynamics(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """Torque that the motors give [N m]: bodies, rotors and friction, shape (n, dof)."""
        return self._of_bodies(q, v, a) + self.residual_torque(q, v, a)

    def residual_torque(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """What is no part of the bodies: friction, springs and offsets, shape (n, dof)."""
        v, laws = np.asarray(v, dtype=float), self.laws
        load, side = self.nominal.gravity_torque(q), np.tanh(v / SLOW)
        per_load = np.where(side * load > 0.0, laws[:, INDEX["load_driving"]], laws[:, INDEX["load_driven"]])
        pace = np.maximum(laws[:, INDEX["stribeck_speed"]], 1e-9)
        near_rest = np.exp(-((v / pace) ** 2))
        growth = 1.0 + laws[:, INDEX["load_stribeck"]] * near_rest
        dry = laws[:, COULOMB] + laws[:, INDEX["static"]] * near_rest
        dry = dry + growth * (per_load * np.abs(load) + laws[:, INDEX["load_squared"]] * load**2)
        per_motor = np.minimum(
            growth * laws[:, INDEX["load_motor"]], 0.99
        )  # K_m |τ_m| with τ_m = load ± friction, solved for the friction
        dry = (dry + per_motor * np.abs(load)) / (1.0 - per_motor * np.sign(side * load))
        spring = laws[:, SPRING] * (np.asarray(q, dtype=float) - laws[:, SPRING_REST])
        return dry * side + spring + (laws[:, VISCOUS] + laws[:, QUADRATIC] * np.abs(v)) * v - laws[:, OFFSET]

    def _of_bodies(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        more = self.laws[:, ROTOR] - self.nominal.armature
        gain = self.laws[:, INDEX["load_gain"]]
        bare = self.nominal.inverse_dynamics(q, v, a) - self.nominal.armature * np.asarray(a, dtype=float)
        return gain * bare + (more + self.nominal.armature) * np.asarray(a, dtype=float)

    def mass_matrix(self, q: Trajectory) -> MassMatrix:
        """Joint-space inertia with the rotors of the servos, shape (n, dof, dof)."""
        return self.nominal.mass_matrix(q) + np.diag(self.laws[:, ROTOR] - self.nominal.armature)

    def gravity_torque(self, q: Trajectory) -> Trajectory:
        """Torque that holds the bodies still, shape (n, dof)."""
        return self.laws[:, INDEX["load_gain"]] * self.nominal.gravity_torque(q)

    def coriolis_torque(self, q: Trajectory, v: Trajectory) -> Trajectory:
        """Centrifugal and Coriolis torques, shape (n, dof)."""
        return self.laws[:, INDEX["load_gain"]] * self.nominal.coriolis_torque(q, v)

    def forward_dynamics(self, q: Trajectory, v: Trajectory, tau: Trajectory) -> Trajectory:
        """Acceleration that motor torque tau gives at (q, v), shape (n, dof)."""
        drift = self.inverse_dynamics(q, v, np.zeros_like(np.asarray(q, dtype=float)))
        return np.linalg.solve(self.mass_matrix(q), (np.asarray(tau) - drift)[..., None])[..., 0]


def save_servo_driven(model: ServoDrivenModel, folder: str | Path, found: Mapping[str, Any] | None = None) -> Path:
    """Writes the folder: the robot's description and every servo's law by name; `found` is kept beside them.

    Returns:
        The folder.
    """
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    description = write_description(model.nominal, out / "robot")
    laws = [{n: float(x) for n, x in zip(NAMES, law, strict=True)} for law in model.laws]
    text = {
        "format": FORMAT,
        "joints": list(model.joints),
        "robot": description.name,
        "voltage": model.voltage,
        "scale_is_set": list(model.scale_is_set),
        "laws": laws,
        "units": {p.name: p.unit for p in LAW},
        **({} if model.surface is None else {"surface": dict(zip(SURFACE, map(float, model.surface), strict=True))}),
        **({} if found is None else {"found": found}),
    }
    write_whole(out / FILE, finite_json(text))
    return out


def load_servo_driven(folder: str | Path, load_robot: Any) -> ServoDrivenModel:
    """Reads what `save_servo_driven` wrote; `load_robot` reads the description inside.

    Raises:
        ModelError: the folder is damaged or from a newer format.
    """
    where = Path(folder) / FILE
    try:
        if where.stat().st_size > MOST_BYTES:
            raise ModelError("is far larger than any servo-driven model", where=str(where))
        text = json.loads(where.read_text(encoding="utf-8"))
        if int(text.get("format", 0)) > FORMAT:
            raise ModelError(f"format {text['format']} is newer than {FORMAT}", where=str(where))
        laws = np.array([[float(law.get(p.name, p.neutral)) for p in LAW] for law in text["laws"]])
        scales, voltage = tuple(bool(x) for x in text["scale_is_set"]), float(text["voltage"])
        robot = load_robot(Path(folder) / Path(str(text["robot"])).name)
        surface = _surface(text.get("surface"), robot.n_dof)
        fits = laws.shape == (robot.n_dof, len(NAMES)) and len(scales) == robot.n_dof and np.isfinite(laws).all()
        if not fits or list(robot.joints) != list(text["joints"]) or not math.isfinite(voltage):
            raise ValueError("its joints are not those of its robot")
        bounds = np.array([[p.lower, p.upper] for p in LAW]).T
        if (laws < bounds[0]).any() or (laws > np.minimum(bounds[1], NO_LIMIT)).any():
            raise ValueError("a parameter is out of its bounds")
    except (OSError, KeyError, TypeError, ValueError, AttributeError) as error:
        raise ModelError(f"is damaged ({error})", where=str(where), next_step="run the diagnosis again") from None
    return ServoDrivenModel(robot, laws, scales, voltage, surface, source=str(folder))


def _surface(given: Any, n_dof: int) -> np.ndarray | None:
    if given is None:
        return None
    surface = np.array([float(given[name]) for name in SURFACE])
    whole = surface[BODY] == int(surface[BODY]) and 0 <= surface[BODY] < n_dof
    if not np.isfinite(surface).all() or not whole or not surface[HARDNESS] > 0.0 or surface[FRICTION] < 0.0:
        raise ValueError("its surface is none that an arm could touch")
    return surface
