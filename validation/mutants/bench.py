"""What mutants are made from: a sound arm, taken apart into its calls, and the case that is put before the suite."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from lagnet.plausibility.settings import CheckSettings
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.descriptions.urdf import read_urdf
from lagnet.rigid_body.descriptions.xml_files import checked_xml
from lagnet.rigid_body.random_arm import random_arm, random_arm_urdf
from lagnet.rigid_body.robot import Robot

JOINTS, SEED = 3, 11
SKEW = np.array([[0.0, 1.0, -0.5], [-1.0, 0.0, 0.8], [0.5, -0.8, 0.0]])


@dataclass(frozen=True, eq=False)
class Case:
    """What the suite is given."""

    model: Any
    reference: Any | None = None
    recordings: tuple[Recording, ...] = ()
    settings: CheckSettings = field(default_factory=CheckSettings)


def sound() -> Robot:
    """The arm that all mutants start from: three revolute joints with limits."""
    return random_arm(JOINTS, SEED, ("revolute",), fixed=False)


def sound_urdf() -> str:
    """Its file."""
    return random_arm_urdf(JOINTS, SEED, ("revolute",), fixed=False)


def robot_from(urdf: str) -> Robot:
    """A robot from the text of a file."""
    return Robot(read_urdf(checked_xml(urdf.encode(), "mutant")))


class Assembled:
    """A model put together from calls; torque is the sum of its parts unless a call says otherwise."""

    def __init__(self, arm: Robot, **calls: Callable[..., np.ndarray]):
        self.joints, self.n_dof, self.joint_types = arm.joints, arm.n_dof, arm.joint_types
        self.position_lower, self.position_upper = arm.position_lower, arm.position_upper
        parts = {name: getattr(arm, name) for name in ("mass_matrix", "coriolis_torque", "gravity_torque")}
        vars(self).update({"inverse_dynamics": self._sum, **parts, **calls})

    def _sum(self, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        parts = vars(self)
        total = np.einsum("nij,nj->ni", parts["mass_matrix"](q), a)
        total = total + parts["coriolis_torque"](q, v) + parts["gravity_torque"](q)
        return total + parts["residual_torque"](q, v, a) if "residual_torque" in parts else total

    def __getattr__(self, name: str) -> Any:  # for type checkers: all calls are attributes of the instance
        raise AttributeError(name)


def added_inertia(
    arm: Robot, value: Callable[[np.ndarray], np.ndarray], slope: Callable[[np.ndarray], np.ndarray]
) -> dict[str, Callable[..., np.ndarray]]:
    """Calls of an arm whose last joint has more inertia, value(q), with the Coriolis torque that goes with it.

    Args:
        arm: the sound arm.
        value: q to (n,); slope: q to its gradient (n, dof).
    """

    def mass_matrix(q: np.ndarray) -> np.ndarray:
        H = arm.mass_matrix(q).copy()
        H[:, -1, -1] += value(q)
        return H

    def coriolis_torque(q: np.ndarray, v: np.ndarray) -> np.ndarray:
        c, gradient = arm.coriolis_torque(q, v).copy(), slope(q)
        c -= 0.5 * gradient * v[:, -1:] ** 2
        c[:, -1] += np.sum(gradient * v, axis=1) * v[:, -1]
        return c

    return {"mass_matrix": mass_matrix, "coriolis_torque": coriolis_torque}


def recording_of(arm: Robot, scale_q: float = 1.0, scale_v: float = 1.0, scale_tau: float = 1.0) -> Recording:
    """Two seconds of swinging within the limits, with the arm's own torque, and signals scaled as asked."""
    time = np.arange(400) / 200.0
    half = 0.4 * (arm.position_upper - arm.position_lower) / 2
    phase = 2 * np.pi * 0.5 * time[:, None] + np.arange(arm.n_dof)
    q, v = half * np.sin(phase), half * np.pi * np.cos(phase)
    tau = arm.inverse_dynamics(q, v, -half * np.pi**2 * np.sin(phase))
    return Recording(time, scale_q * q, scale_tau * tau, arm.joints, v=scale_v * v)
