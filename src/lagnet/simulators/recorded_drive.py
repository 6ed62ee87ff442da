"""What drove a recorded arm, on the even clock of a replay: its torque with soft feedback, or its commands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.interpolate import make_interp_spline

from lagnet.errors import LagnetError
from lagnet.recordings.conditioning.condition import condition
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import Robot
from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics
from lagnet.types import JointVector, Samples, Trajectory

if TYPE_CHECKING:
    from lagnet.simulators.replay import ReplaySettings

SHORTEST = 0.5  # [s] of a stretch that is replayed


@dataclass(frozen=True, eq=False)
class RecordedDrive:
    """One uninterrupted stretch.

    Args:
        recording: file name.
        time: shape (n,), even clock [s].
        q, v: shape (n, dof), recorded motion, smoothed [rad, rad/s].
        logged: shape (n, dof), recorded torque, or feed-forward of a servo [N m].
        target, target_speed: shape (n, dof), what feedback pulls to [rad, rad/s].
        kp, kd: shape (dof,), gains of the feedback.
        commanded: whether the target is a recorded command, else the recorded motion.
    """

    recording: str
    time: Samples
    q: Trajectory
    v: Trajectory
    logged: Trajectory
    target: Trajectory
    target_speed: Trajectory
    kp: JointVector
    kd: JointVector
    commanded: bool

    @property
    def step(self) -> float:
        """Period of the clock [s]."""
        return float(self.time[1] - self.time[0])

    def torque(self, k: int, q: JointVector, v: JointVector) -> JointVector:
        """Torque that is sent to the simulated arm in period k, shape (dof,) [N m]."""
        return self.logged[k] + self.kp * (self.target[k] - q) + self.kd * (self.target_speed[k] - v)


def recorded_drives(
    recording: Recording, nominal: Robot, arm: ArmPhysics, settings: ReplaySettings
) -> list[RecordedDrive]:
    """The stretches of a recording, brought to the rate of a replay.

    Args:
        nominal: the robot whose inertia scales soft feedback, the same before and after.
        arm: the simulated arm, whose log may be late.

    Raises:
        LagnetError: other joints, or commands without gains.
    """
    if tuple(recording.joints) != tuple(nominal.joints):
        raise LagnetError(
            f"has the joints {', '.join(recording.joints)}, the model {', '.join(nominal.joints)}",
            where=recording.path or None,
            next_step="give the recording's own robot",
        )
    command = getattr(recording, "command", None)
    if command is not None and settings.servo is not None:
        gains = np.array(settings.servo.kp), np.array(settings.servo.kd)
        return commanded_stretches(recording, np.asarray(command), settings, gains)
    if recording.tau is None:
        raise LagnetError(
            "holds commands and no torque",
            where=recording.path or None,
            next_step="give the servo's gains with --kp and --kd",
        )
    return _of_torques(recording, nominal, arm, settings)


def _name(recording: Recording) -> str:
    return recording.path.rsplit("/", 1)[-1] or "recording"


def _of_torques(recording: Recording, nominal: Robot, arm: ArmPhysics, settings: ReplaySettings) -> list[RecordedDrive]:
    out = []
    late = np.array([d.late for d in arm.drives])
    for stretch in condition([recording]).stretches:
        end = min(float(stretch.time[-1]), float(stretch.time[0]) + settings.longest)
        if end - stretch.time[0] < SHORTEST:
            continue
        clock = np.arange(int((end - stretch.time[0]) * settings.rate)) / settings.rate + stretch.time[0]
        q, v = (make_interp_spline(stretch.time, x, k=3, axis=0)(clock) for x in (stretch.q, stretch.v))
        tau = np.column_stack(
            [np.interp(clock + lag, stretch.time, x) for lag, x in zip(late, stretch.tau.T, strict=True)]
        )
        every = max(1, len(q) // 50)
        inertia = np.mean(np.diagonal(nominal.mass_matrix(q[::every]), axis1=1, axis2=2), axis=0)
        kp, kd = inertia * settings.bandwidth**2, 2.0 * inertia * settings.bandwidth
        out.append(RecordedDrive(_name(recording), clock, q, v, tau, q, v, kp, kd, False))
    return out


def commanded_stretches(
    recording: Recording, command: np.ndarray, settings: ReplaySettings, gains: tuple[np.ndarray, np.ndarray]
) -> list[RecordedDrive]:
    """Stretches under commands, which are held from sample to sample, as a servo gets them.

    Args:
        recording: what was measured.
        command: shape (n, dof) [rad or m].
        settings: how it is replayed.
        gains: kp and kd of the feedback, shape (dof,) each.

    Raises:
        LagnetError: gains for another number of joints.
    """
    kp, kd = gains
    if kp.shape != (recording.n_dof,) or kd.shape != (recording.n_dof,):
        raise LagnetError(f"{kp.size} and {kd.size} gains for {recording.n_dof} joints", where="--kp, --kd")
    speed = getattr(recording, "command_velocity", None)
    forward = getattr(recording, "command_torque", None)
    out = []
    for label in np.unique(recording.trajectory):
        rows = np.flatnonzero(recording.trajectory == label)
        time = recording.time[rows]
        end = min(float(time[-1]), float(time[0]) + settings.longest)
        if end - time[0] < SHORTEST:
            continue
        clock = np.arange(int((end - time[0]) * settings.rate)) / settings.rate + time[0]
        held = rows[np.clip(np.searchsorted(time, clock + 1e-9, side="right") - 1, 0, rows.size - 1)]
        curve = make_interp_spline(time, recording.q[rows], k=3, axis=0)
        still = np.zeros((clock.size, recording.n_dof))
        target_speed = still if speed is None else speed[held]
        logged = still if forward is None else forward[held]
        motion = curve(clock), curve.derivative()(clock)
        out.append(RecordedDrive(_name(recording), clock, *motion, logged, command[held], target_speed, kp, kd, True))
    return out
