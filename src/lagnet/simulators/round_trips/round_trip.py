"""The same command to a corrected model and to its export in an engine: how far the two motions part.

Both are held to a wanted motion by one controller that knows the nominal bodies alone. An effect's contribution is how
far it moves the corrected model off the nominal one; the error of an export is counted in shares of it.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.robot import Robot
from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics
from lagnet.simulators.corrected_arm.driven_arm import DrivenArm
from lagnet.simulators.engines.engine import Engine
from lagnet.simulators.exporter import Exporter
from lagnet.simulators.round_trips.reference_cases import COMPANIONS, case_values
from lagnet.simulators.round_trips.tracking_control import TrackingControl, tracking
from lagnet.types import Trajectory

RATE = 1000.0  # [Hz], of the controller
BANDWIDTH = 20.0  # [rad/s], of the feedback: soft, so that effects show
SETTLING = 1.0  # [s] over which a motion sets in
OMEGA = np.array([1.1, 1.7, 2.3])  # [rad/s], taken in turn by the joints
REACH = np.array([0.6, 0.5, 0.7])  # [rad]
SHARP = 1e-6  # [rad/s], blur of s(v) of a case

EngineOf = Callable[[Path, ArmPhysics], Engine]


@dataclass(frozen=True)
class RoundTrip:
    """One effect in one engine.

    Args:
        effect: name in the catalogue.
        engine: name of the engine.
        contribution: root mean square by which the effect moves the arm [rad].
        error: root mean square between engine and corrected model [rad].
    """

    effect: str
    engine: str
    contribution: float
    error: float

    @property
    def share(self) -> float:
        """Error over contribution."""
        return self.error / self.contribution


def smooth_motion(seconds: float, n_dof: int) -> tuple[np.ndarray, tuple[Trajectory, Trajectory, Trajectory]]:
    """Time and a motion of sines that sets in from rest: q, v, a of shape (n, dof)."""
    time = np.arange(round(seconds * RATE)) / RATE
    omega, reach = (np.resize(x, n_dof) for x in (OMEGA, REACH))
    s = np.clip(time / SETTLING, 0.0, 1.0)[:, None]
    on, on1, on2 = s**3 * (10 - 15 * s + 6 * s**2), 30 * s**2 * (1 - s) ** 2, 60 * s * (1 - s) * (1 - 2 * s)
    on1, on2 = on1 / SETTLING, on2 / SETTLING**2
    phase = time[:, None] * omega
    wave, wave1, wave2 = reach * np.sin(phase), reach * omega * np.cos(phase), -reach * omega**2 * np.sin(phase)
    return time, (on * wave, on1 * wave + on * wave1, on2 * wave + 2 * on1 * wave1 + on * wave2)


def control_of(robot: Robot, seconds: float) -> TrackingControl:
    """The controller of round trips for an arm."""
    time, motion = smooth_motion(seconds, robot.n_dof)
    return tracking(robot, time, motion, BANDWIDTH)


def case_of(robot: Robot, name: str, joint: int | None, **changed: float) -> CorrectedModel:
    """A robot that lacks one effect of the reference cases, and what stands beside it."""
    beside = companions_of(robot, name, joint)
    named = NamedEffect(name, joint, {**case_values(name), **changed})
    return beside.with_effects((*beside.effects, named))


def companions_of(robot: Robot, name: str, joint: int | None) -> CorrectedModel:
    """The robot of a case without the effect itself."""
    beside = tuple(NamedEffect(other, joint, dict(values)) for other, values in COMPANIONS.get(name, {}).items())
    return CorrectedModel(robot, beside, np.full(robot.n_dof, SHARP))


def reference_motion(arm: ArmPhysics, control: TrackingControl, step: float = 1.0 / RATE) -> Trajectory:
    """Positions of the corrected model itself under a controller, shape (n, dof) [rad]."""
    return control.run(DrivenArm(arm, step, control.q[0], control.v[0]))[0]


def engine_motion(exporter: Exporter, arm: ArmPhysics, engine_of: EngineOf, control: TrackingControl) -> Trajectory:
    """Positions of the exported model in an engine under a controller, shape (n, dof) [rad]."""
    with tempfile.TemporaryDirectory() as folder:
        exporter.write(arm, Path(folder))
        with engine_of(Path(folder), arm) as engine:
            engine.put(control.q[0], control.v[0])
            return control.run(engine)[0]


def size_of(motion: Trajectory) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(motion**2)))
