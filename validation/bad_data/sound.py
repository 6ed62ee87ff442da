"""Sound recordings of arms that come by name: motion within the limits, rigid bodies, friction, noise, a scale."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import Robot

HARMONICS = 5
USED = 0.8  # of a joint's speed limit


@dataclass(frozen=True)
class SoundSettings:
    """How a sound recording is made.

    Args:
        samples: of each recording.
        rate: [Hz].
        torque_noise: as a share of each joint's usual torque.
        position_steps: of a turn, of the encoders; 0 for none.
        jitter: of the clock, as a share of a step.
        stops: whether the arm moves from point to point and rests between.
        viscous, coulomb: friction, in parts of each joint's usual torque at its usual speed.
        velocity: whether speeds are recorded.
    """

    samples: int = 2000
    rate: float = 100.0
    torque_noise: float = 0.01
    position_steps: int = 2**20
    jitter: float = 0.0
    stops: bool = False
    viscous: float = 0.2
    coulomb: float = 0.0
    velocity: bool = False


def drawn_settings(rng: np.random.Generator) -> SoundSettings:
    """Any of the kinds of recording that laboratories have."""
    return SoundSettings(
        samples=int(rng.integers(1500, 4000)),
        rate=float(rng.choice([50.0, 100.0, 125.0, 200.0, 500.0, 1000.0])),
        torque_noise=float(rng.choice([0.0, 0.003, 0.01, 0.05])),
        position_steps=int(rng.choice([0, 2**14, 2**17, 2**20])),
        jitter=float(rng.choice([0.0, 0.02, 0.2])),
        stops=bool(rng.random() < 0.3),
        viscous=float(rng.uniform(0.0, 0.5)),
        coulomb=float(rng.choice([0.0, 0.1, 0.4])),
        velocity=bool(rng.random() < 0.4),
    )


def sound_recording(robot: Robot, settings: SoundSettings, rng: np.random.Generator, path: str = "") -> Recording:
    """One recording of a robot that moves as its file says."""
    step = 1.0 / settings.rate
    time = np.arange(settings.samples) * step
    time = time + settings.jitter * step * rng.uniform(-0.5, 0.5, time.size)
    q, v, a = _stops(robot, time, rng) if settings.stops else _waves(robot, time, rng)
    tau = robot.inverse_dynamics(q, v, a)
    size, speed = tau.std(axis=0) + 1e-3 * np.abs(tau).max(), v.std(axis=0) + 1e-9
    tau = tau + size * (settings.viscous * v / speed + settings.coulomb * np.tanh(v / (0.02 * speed)))
    tau = tau + settings.torque_noise * size * rng.standard_normal(tau.shape)
    if settings.position_steps:
        scale = 2 * np.pi / settings.position_steps
        q = np.round(q / scale) * scale
    v = v + 1e-3 * speed * rng.standard_normal(v.shape)
    return Recording(time, q, tau, robot.joints, v=v if settings.velocity else None, path=path)


def _centre(robot: Robot) -> tuple[np.ndarray, np.ndarray]:
    low = np.where(np.isfinite(robot.position_lower), robot.position_lower, -2.0)
    high = np.where(np.isfinite(robot.position_upper), robot.position_upper, 2.0)
    half = np.minimum(0.4 * (high - low), 1.2)
    return 0.5 * (low + high), half


def _waves(robot: Robot, time: np.ndarray, rng: np.random.Generator) -> tuple[np.ndarray, ...]:
    """Sums of sines with their derivatives."""
    centre, half = _centre(robot)
    base = rng.uniform(0.05, 0.2) * 2 * np.pi
    omega = base * np.arange(1, HARMONICS + 1)
    size = rng.uniform(0.2, 1.0, (HARMONICS, robot.n_dof)) / np.arange(1, HARMONICS + 1)[:, None]
    size *= half / size.sum(axis=0)
    phase = rng.uniform(0, 2 * np.pi, size.shape)
    angle = omega[:, None, None] * time[None, :, None] + phase[:, None, :]
    limit = np.where(np.isfinite(robot.velocity_limit) & (robot.velocity_limit > 0), robot.velocity_limit, np.inf)
    by = np.minimum(1.0, USED * limit / np.sum(size * omega[:, None], axis=0))
    size = size * by
    q = centre + np.sum(size[:, None] * np.sin(angle), axis=0)
    v = np.sum((size * omega[:, None])[:, None] * np.cos(angle), axis=0)
    a = -np.sum((size * omega[:, None] ** 2)[:, None] * np.sin(angle), axis=0)
    return q, v, a


def _stops(robot: Robot, time: np.ndarray, rng: np.random.Generator) -> tuple[np.ndarray, ...]:
    """From point to point along quintic polynomials, with rests between."""
    centre, half = _centre(robot)
    q, v, a = (np.zeros((time.size, robot.n_dof)) for _ in range(3))
    here, start = centre + half * rng.uniform(-1, 1, robot.n_dof), time[0]
    while start < time[-1]:
        there, long, rest = (
            centre + half * rng.uniform(-1, 1, robot.n_dof),
            rng.uniform(1.0, 2.5),
            rng.uniform(0.1, 1.0),
        )
        rows = (time >= start) & (time <= start + long + rest)
        s = np.clip((time[rows] - start) / long, 0.0, 1.0)[:, None]
        way = there - here
        q[rows] = here + way * (10 * s**3 - 15 * s**4 + 6 * s**5)
        v[rows] = way / long * (30 * s**2 - 60 * s**3 + 30 * s**4)
        a[rows] = way / long**2 * (60 * s - 180 * s**2 + 120 * s**3)
        here, start = there, start + long + rest
    return q, v, a
