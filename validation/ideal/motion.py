"""Random motion in many segments: each a quintic from one configuration at rest to the next."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import Robot


@dataclass(frozen=True)
class MotionSettings:
    """Length and reach of random motions.

    Args:
        motions: number of motions; segments: of each.
        rate: samples a second [Hz].
        reach: configurations are drawn from ±reach [rad].
        shortest, longest: duration of a segment [s].
    """

    motions: int = 140
    segments: int = 10
    rate: float = 25.0
    reach: float = np.pi
    shortest: float = 1.0
    longest: float = 2.5


def random_motion(robot: Robot, settings: MotionSettings, seed: int, samples: int | None = None) -> Recording:
    """Motion with the torque that rigid-body inverse dynamics give for it.

    Args:
        robot: the arm.
        settings: length and reach.
        seed: of the random draws.
        samples: number of samples to keep, None for all.
    """
    rng = np.random.default_rng(seed)
    parts = [_motion(rng, robot.n_dof, settings) for _ in range(settings.motions)]
    q, v, a = (np.concatenate([part[k] for part in parts])[:samples] for k in range(3))
    label = np.concatenate([np.full(len(part[0]), i) for i, part in enumerate(parts)])[:samples]
    return Recording(
        time=np.arange(len(q)) / settings.rate,
        q=q,
        v=v,
        a=a,
        tau=robot.inverse_dynamics(q, v, a),
        joints=robot.joints,
        trajectory=label,
        trajectory_names=tuple(map(str, range(settings.motions))),
    )


def _motion(rng: np.random.Generator, n_dof: int, settings: MotionSettings) -> tuple[np.ndarray, ...]:
    start, segments = rng.uniform(-settings.reach, settings.reach, n_dof), []
    for _ in range(settings.segments):
        goal = rng.uniform(-settings.reach, settings.reach, n_dof)
        segments.append(_segment(start, goal, rng.uniform(settings.shortest, settings.longest), settings.rate))
        start = goal
    return tuple(np.concatenate(part) for part in zip(*segments, strict=True))


def _segment(start: np.ndarray, goal: np.ndarray, duration: float, rate: float) -> tuple[np.ndarray, ...]:
    """Quintic with zero speed and acceleration at both ends."""
    s = np.arange(0.0, duration, 1.0 / rate)[:, None] / duration
    way = goal - start
    q = start + (10 * s**3 - 15 * s**4 + 6 * s**5) * way
    v = (30 * s**2 - 60 * s**3 + 30 * s**4) * way / duration
    a = (60 * s - 180 * s**2 + 120 * s**3) * way / duration**2
    return q, v, a
