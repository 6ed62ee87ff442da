"""Reference motions of the concealed plants: Fourier sums, waypoints with dwells, slow sweeps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from validation.plants.body import JointLimits


@dataclass(frozen=True)
class Reference:
    """A wanted motion on an even clock: time (n,), q, v, a (n, dof)."""

    time: np.ndarray
    q: np.ndarray
    v: np.ndarray
    a: np.ndarray


@dataclass(frozen=True)
class MotionSettings:
    """How wide, fast and abrupt a motion may be."""

    duration: float = 30.0  # [s]
    rate: float = 2000.0  # [Hz]
    reach: float = 1.6  # widest excursion from the centre [rad]
    speed_share: float = 0.7  # of the joint's speed limit
    top_speed: float = 2.0  # [rad/s], whatever the limit
    top_acceleration: float = 7.0  # [rad/s²]


def _room(limit: JointLimits, settings: MotionSettings, rng: np.random.Generator) -> tuple[float, float]:
    """Centre and half width of the range that one joint uses, 5 % away from its limits."""
    lower, upper = max(limit.lower, -2.6), min(limit.upper, 5.5)
    span = 0.9 * (upper - lower)
    half = min(settings.reach, span / 2) * rng.uniform(0.75, 1.0)
    middle, slack = (lower + upper) / 2, span / 2 - half
    return middle + rng.uniform(-1, 1) * slack * 0.6, half


def _fourier(time: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    base = 2 * np.pi / rng.uniform(9.0, 12.0)
    harmonics = np.arange(1, rng.integers(5, 9))
    amplitude = rng.normal(size=harmonics.size) / harmonics ** rng.uniform(0.3, 1.0)
    phase = rng.uniform(0, 2 * np.pi, harmonics.size)
    return np.sin(base * time[:, None] * harmonics + phase) @ amplitude


def _ramps(time: np.ndarray, knots: Sequence[float], values: Sequence[float]) -> np.ndarray:
    """Quintic (rest to rest) moves between values; equal neighbours make a dwell."""
    knots, values = np.asarray(knots), np.asarray(values)
    i = np.clip(np.searchsorted(knots, time, side="right") - 1, 0, len(knots) - 2)
    s = np.clip((time - knots[i]) / (knots[i + 1] - knots[i]), 0, 1)
    return values[i] + (values[i + 1] - values[i]) * s**3 * (10 - 15 * s + 6 * s**2)


def _waypoints(time: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    knots, values = [0.0], [rng.uniform(-1, 1)]
    while knots[-1] < time[-1]:
        knots.append(knots[-1] + rng.uniform(0.8, 3.0))
        values.append(values[-1] if rng.random() < 0.1 else float(rng.uniform(-1, 1)))
    return _ramps(time, knots, values)


def _sweeps(time: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    knots, values, side = [0.0], [-1.0], 1.0
    while knots[-1] < time[-1]:
        knots.append(knots[-1] + rng.uniform(3.0, 9.0))
        values.append(side * rng.uniform(0.6, 1.0))
        side = -side
    return _ramps(time, knots, values) + 0.04 * _fourier(time * 1.5, rng)


SHAPES: dict[str, Callable[[np.ndarray, np.random.Generator], np.ndarray]] = {
    "fourier": _fourier,
    "waypoints": _waypoints,
    "sweeps": _sweeps,
}


def reference(
    shape: str, limits: Sequence[JointLimits], settings: MotionSettings, rng: np.random.Generator
) -> Reference:
    """A motion of one shape for all joints, each within its own position, speed and acceleration limits."""
    step = 1 / settings.rate
    time = np.arange(round(settings.duration * settings.rate)) * step
    q = np.stack([_joint(shape, time, limit, settings, rng) for limit in limits], axis=1)
    v = np.gradient(q, step, axis=0)
    return Reference(time, q, v, np.gradient(v, step, axis=0))


def _joint(
    shape: str, time: np.ndarray, limit: JointLimits, settings: MotionSettings, rng: np.random.Generator
) -> np.ndarray:
    centre, half = _room(limit, settings, rng)
    signal = SHAPES[shape](time, rng)
    signal = (signal - signal.mean()) / np.abs(signal - signal.mean()).max()
    speed = np.abs(np.gradient(signal, time)).max()
    acceleration = np.abs(np.gradient(np.gradient(signal, time), time)[2:-2]).max()
    top = min(settings.top_speed, settings.speed_share * limit.speed)
    share = rng.uniform(0.7, 1.0)
    stretch = 0.02 if limit.kind == "prismatic" else 1.0  # fingers move by millimetres
    return centre + signal * min(half, share * top / speed, stretch * settings.top_acceleration / acceleration)
