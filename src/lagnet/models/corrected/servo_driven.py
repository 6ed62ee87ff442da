"""A robot with the servos that drive it: it answers for torques, and rolls out commands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, final

import numpy as np

from lagnet.rigid_body.kinematic_tree import KinematicTree, kinematic_tree
from lagnet.rollout.whole_arm import roll_out_arm
from lagnet.servos.parameters import (
    COULOMB,
    INDEX,
    NO_LIMIT,
    OFFSET,
    QUADRATIC,
    ROTOR,
    SPRING,
    SPRING_REST,
    VISCOUS,
)
from lagnet.types import JointVector, MassMatrix, Samples, Trajectory

SLOW = 0.02  # [rad/s] over which dry friction changes its side where torque is asked for sample by sample
STEP = 0.004  # [s] of a rollout at most


@dataclass(frozen=True)
class FoundCause:
    """A cause that a diagnosis found.

    Args:
        effect: name of a servo effect, or "payload" or "surface_contact".
        joint: index of the joint, None for the whole arm.
        status: as in the verdict: "named", "tied", …
        values: its parameters by name, SI units; those of a joint are in its law.
    """

    effect: str
    joint: int | None
    status: str
    values: Mapping[str, float]


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
        causes: what a diagnosis named of it.
        before: the robot and the servos that it corrects; None where that is not known.
        source, sha256: what it was read from, "" if nothing.
    """

    nominal: Any
    laws: np.ndarray
    scale_is_set: tuple[bool, ...]
    voltage: float = 0.0
    surface: np.ndarray | None = None
    causes: tuple[FoundCause, ...] = ()
    before: ServoDrivenModel | None = None
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

    def at_gain(self, gain: float) -> ServoDrivenModel:
        """The model whose controllers have so many times the gains, their full duty kept."""
        laws = self.laws.copy()
        laws[:, [INDEX["kp"], INDEX["ki"]]] *= gain
        laws[:, INDEX["full_error"]] = np.minimum(laws[:, INDEX["full_error"]] / gain, NO_LIMIT)
        return replace(self, laws=laws)

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
