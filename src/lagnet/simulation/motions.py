"""Motions that excite an arm's dynamics: random moves, Fourier sums, points with dwells, slow sweeps, reversals.

Each shape is a signal for one joint in units of its range; `draw_motion` fits it into the joint's limits.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lagnet.errors import LagnetError
from lagnet.rigid_body.robot import Robot
from lagnet.types import Samples, Trajectory

FREE_RANGE = 2.5  # [rad] either way where the description states no position limit
FREE_SPEED = 1.5  # [rad/s] where it states no speed limit
SLIDE = 0.1  # what a metre of a prismatic joint counts in the radians of the settings above


@dataclass(frozen=True)
class MotionSettings:
    """How long, wide and fast motions are.

    Args:
        duration: [s].
        rate: samples a second of the wanted motion [Hz].
        reach: widest excursion from the middle of a motion [rad]: moderate, to stay clear of the arm itself.
        range_share, speed_share: part of the position range and of the speed limit that is used.
        top_speed: [rad/s] whatever the limit.
        top_acceleration: [rad/s²].
    """

    duration: float = 20.0
    rate: float = 1000.0
    reach: float = 1.5
    range_share: float = 0.9
    speed_share: float = 0.7
    top_speed: float = 2.0
    top_acceleration: float = 8.0


@dataclass(frozen=True, eq=False)
class WantedMotion:
    """Joint motion on an even clock: time (n,) [s], q, v, a (n, dof) [rad, rad/s, rad/s²]."""

    time: Samples
    q: Trajectory
    v: Trajectory
    a: Trajectory


@dataclass(frozen=True, eq=False)
class _Signal:
    """One joint's position and its exact derivatives, shape (n,) each."""

    x: np.ndarray
    dx: np.ndarray
    ddx: np.ndarray


def _fourier(time: np.ndarray, rng: np.random.Generator) -> _Signal:
    """A band-limited sum of sines: excites all inertial terms, passes through zero speed often."""
    base = 2 * np.pi / 10.0
    k = base * np.arange(1, 6)
    sine, cosine = rng.normal(size=(2, k.size)) / np.sqrt(np.arange(1, 6))
    phase = time[:, None] * k
    s, c = np.sin(phase), np.cos(phase)
    return _Signal(s @ sine + c @ cosine, c @ (k * sine) - s @ (k * cosine), -s @ (k**2 * sine) - c @ (k**2 * cosine))


def _segments(time: np.ndarray, knots: np.ndarray, values: np.ndarray) -> _Signal:
    """Quintic moves from rest to rest between values; equal neighbours are a dwell."""
    i = np.clip(np.searchsorted(knots, time, side="right") - 1, 0, knots.size - 2)
    length, step = knots[i + 1] - knots[i], values[i + 1] - values[i]
    s = np.clip((time - knots[i]) / length, 0.0, 1.0)
    return _Signal(
        values[i] + step * s**3 * (10 - 15 * s + 6 * s**2),
        step / length * 30 * s**2 * (1 - s) ** 2,
        step / length**2 * 60 * s * (1 - s) * (1 - 2 * s),
    )


def _knots(time: np.ndarray, shortest: float, longest: float, rng: np.random.Generator) -> np.ndarray:
    knots = [0.0]
    while knots[-1] <= time[-1]:
        knots.append(knots[-1] + rng.uniform(shortest, longest))
    return np.array(knots)


def _random_moves(time: np.ndarray, rng: np.random.Generator) -> _Signal:
    """Moves between random positions, each joint in its own rhythm."""
    knots = _knots(time, 1.0, 3.0, rng)
    return _segments(time, knots, rng.uniform(-1, 1, knots.size))


def _point_to_point(time: np.ndarray, rng: np.random.Generator) -> _Signal:
    """Moves between positions with a stop after each: what a pick-and-place robot does all day."""
    knots = _knots(time, 0.6, 1.8, rng)
    values = rng.uniform(-1, 1, knots.size)
    values[1::2] = values[::2][: values[1::2].size]
    return _segments(time, knots, values)


def _slow_sweeps(time: np.ndarray, rng: np.random.Generator) -> _Signal:
    """Long slow strokes from end to end: shows friction at low speed and what depends on position."""
    knots = _knots(time, 7.0, 12.0, rng)
    values = np.where(np.arange(knots.size) % 2, 1.0, -1.0) * rng.choice([-1.0, 1.0])
    return _segments(time, knots, values * rng.uniform(0.7, 1.0, knots.size))


def _reversals(time: np.ndarray, rng: np.random.Generator) -> _Signal:
    """Short strokes back and forth around a drifting middle: many passes through zero speed."""
    knots = _knots(time, 0.4, 0.9, rng)
    drift = np.cumsum(rng.normal(0, 0.15, knots.size))
    drift -= np.linspace(drift[0], drift[-1], knots.size)
    return _segments(time, knots, np.clip(drift, -0.8, 0.8) + np.where(np.arange(knots.size) % 2, 0.2, -0.2))


SHAPES: dict[str, Callable[[np.ndarray, np.random.Generator], _Signal]] = {
    "random_moves": _random_moves,
    "fourier": _fourier,
    "slow_sweeps": _slow_sweeps,
    "reversals": _reversals,
    "point_to_point": _point_to_point,
}


def draw_motion(robot: Robot, shape: str, settings: MotionSettings, seed: int) -> WantedMotion:
    """A motion of one shape for every joint, within position, speed and acceleration limits.

    Args:
        robot: whose limits hold; stand-ins where the description states none.
        shape: a name of `SHAPES`.
        settings: how long, wide and fast.
        seed: the same seed gives the same motion.

    Raises:
        LagnetError: unknown shape.
    """
    if shape not in SHAPES:
        raise LagnetError(f"unknown motion {shape!r}", choices=SHAPES)
    rng = np.random.default_rng(seed)
    time = np.arange(round(settings.duration * settings.rate)) / settings.rate
    signals = [_fitted(SHAPES[shape](time, rng), robot, j, settings, rng) for j in range(robot.n_dof)]
    q, v, a = (np.column_stack(parts) for parts in zip(*((s.x, s.dx, s.ddx) for s in signals), strict=True))
    return WantedMotion(time, q, v, a)


def position_range(robot: Robot, joint: int) -> tuple[float, float]:
    """Positions [rad or m] that a joint may take, a moderate range where the description states none."""
    free = FREE_RANGE * (SLIDE if robot.joint_types[joint] == "prismatic" else 1.0)
    lower, upper = float(robot.position_lower[joint]), float(robot.position_upper[joint])
    if not np.isfinite(lower) or not np.isfinite(upper) or lower >= upper:
        return -free, free
    return (max(lower, -free), min(upper, free)) if lower < 0 < upper else (lower, min(upper, lower + 2 * free))


def _fitted(signal: _Signal, robot: Robot, joint: int, settings: MotionSettings, rng: np.random.Generator) -> _Signal:
    """The signal, centred and scaled so that no limit of the joint is passed."""
    lower, upper = position_range(robot, joint)
    scale = min(1.0, (upper - lower) / 2)  # a finger's millimetres come with a finger's accelerations
    half = min(settings.reach, settings.range_share * (upper - lower) / 2) * rng.uniform(0.7, 1.0)
    slack = settings.range_share * (upper - lower) / 2 - half
    centre = (lower + upper) / 2 + rng.uniform(-0.5, 0.5) * slack
    limit = float(robot.velocity_limit[joint])
    limit = limit if np.isfinite(limit) and limit > 0 else FREE_SPEED * scale
    speed = min(settings.top_speed, settings.speed_share * limit) * rng.uniform(0.7, 1.0)
    middle = (signal.x.max() + signal.x.min()) / 2
    factor = min(
        half / max(np.abs(signal.x - middle).max(), 1e-9),
        speed / max(np.abs(signal.dx).max(), 1e-9),
        settings.top_acceleration * scale / max(np.abs(signal.ddx).max(), 1e-9),
    )
    return _Signal(centre + factor * (signal.x - middle), factor * signal.dx, factor * signal.ddx)
