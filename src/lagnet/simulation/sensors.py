"""The measuring chain: sampling, encoder steps, noise and a clock that is not quite even."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.recordings.recording import Recording
from lagnet.simulation.closed_loop import TrueRun
from lagnet.types import Samples, Trajectory


@dataclass(frozen=True)
class SensorSettings:
    """What the recording loses of the truth.

    Args:
        rate: samples a second [Hz].
        torque_noise: rms as a share of the rms of each joint's torque.
        encoder_bits: steps of a turn (or metre) as a power of two; 0 for none.
        records_velocity: whether speeds are recorded too.
        velocity_noise: rms [rad/s].
        clock_jitter: rms [s] of the instants of the samples; the recorded time is the true one.
    """

    rate: float = 100.0
    torque_noise: float = 0.01
    encoder_bits: int = 20
    records_velocity: bool = False
    velocity_noise: float = 1e-3
    clock_jitter: float = 0.0


def record(run: TrueRun, tau: Trajectory, joints: tuple[str, ...], settings: SensorSettings, seed: int) -> Recording:
    """Sample a true run.

    Args:
        run: what happened.
        tau: shape (n, dof), the torque signal that the sensors give out [N m].
        joints: names in model order.
        settings: the measuring chain.
        seed: of all noise.
    """
    rng = np.random.default_rng(seed)
    step = float(run.time[1] - run.time[0])
    clock = _clock(run.time, step, settings, rng)
    q, v, tau = (_at(clock, run.time, x) for x in (run.q, run.v, tau))
    noise = settings.torque_noise * np.sqrt(np.mean(tau**2, axis=0))
    tau = tau + rng.normal(size=tau.shape) * noise
    if settings.encoder_bits:
        grain = 2 * np.pi / 2**settings.encoder_bits
        q = np.round(q / grain) * grain
    seen_v = v + rng.normal(size=v.shape) * settings.velocity_noise if settings.records_velocity else None
    return Recording(clock, q, tau, joints, v=seen_v)


def _clock(time: Samples, step: float, settings: SensorSettings, rng: np.random.Generator) -> Samples:
    every = max(1, round(1 / (settings.rate * step)))
    clock = time[::every].copy()
    if settings.clock_jitter:
        wander = rng.normal(0.0, settings.clock_jitter, clock.size)
        most = 0.3 * every * step  # samples never change places
        clock = np.clip(clock + np.clip(wander, -most, most), time[0], time[-1])
    return clock


def _at(clock: Samples, time: Samples, signal: Trajectory) -> Trajectory:
    return np.column_stack([np.interp(clock, time, column) for column in signal.T])
