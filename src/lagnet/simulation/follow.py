"""Simulate an arm that is sent along a motion given beforehand, such as one that a diagnosis suggests."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.interpolate import make_interp_spline

from lagnet.errors import LagnetError
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import Robot
from lagnet.simulation.closed_loop import run_closed_loop
from lagnet.simulation.injection import InjectedEffect, StepPhysics, seen_torque
from lagnet.simulation.motions import WantedMotion
from lagnet.simulation.sensors import record
from lagnet.simulation.simulate import SimulationSettings, check_settings
from lagnet.types import Samples, Trajectory

LEAST = 12  # samples from which two derivatives can be taken


def follow(
    robot: Robot,
    effects: Sequence[InjectedEffect],
    time: Samples,
    q: Trajectory,
    settings: SimulationSettings | None = None,
) -> Recording:
    """Record the arm along a wanted motion.

    Args:
        robot: the nominal model, which the controller knows.
        effects: what the recording shows and the nominal model lacks.
        time: shape (n,), [s], increasing.
        q: shape (n, dof), wanted positions at these times [rad].
        settings: engine, controller, sensors and the seed of the noise; their motions are not used.

    Raises:
        LagnetError: another number of joints, too few samples, or settings that make no sense.
        MissingExtraError: the engine is not installed.
    """
    settings = settings or SimulationSettings()
    check_settings(settings)
    wanted = at_rate(time, q, settings.motion.rate)
    if wanted.q.shape[1] != robot.n_dof:
        raise LagnetError(f"the motion has {wanted.q.shape[1]} joints, the robot {robot.n_dof}", choices=robot.joints)
    slow = np.full(robot.n_dof, settings.slow)
    run = run_closed_loop(robot, StepPhysics.of(robot, effects, slow), wanted, settings.loop)
    tau = seen_torque(effects, robot, slow, (run.time, run.q, run.v, run.a, run.tau))
    return record(run, tau, robot.joints, settings.sensors, settings.seed)


def at_rate(time: Samples, q: Trajectory, rate: float) -> WantedMotion:
    """A motion through given positions with its derivatives, on an even clock of `rate` [Hz] that starts at zero.

    Raises:
        LagnetError: too few samples.
    """
    if time.size < LEAST:
        raise LagnetError(f"a motion of {time.size} samples cannot be followed", next_step=f"give at least {LEAST}")
    clock = np.arange(round((time[-1] - time[0]) * rate) + 1) / rate
    curve = make_interp_spline(time - time[0], q, k=5, axis=0)
    at = np.clip(clock, 0.0, time[-1] - time[0])
    return WantedMotion(clock, curve(at), curve.derivative(1)(at), curve.derivative(2)(at))
