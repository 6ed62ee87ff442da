"""Sizes of motion and torque that a model carries with it, so that callers only ever see SI units."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Scales:
    """Typical size of each joint's velocity [rad/s], acceleration [rad/s²] and torque [N m] in the training data.

    Args:
        velocity, acceleration: root mean square of each joint; torque: its standard deviation.
    """

    velocity: tuple[float, ...]
    acceleration: tuple[float, ...]
    torque: tuple[float, ...]

    @property
    def inertia(self) -> tuple[float, ...]:
        """Torque over acceleration [kg m²], the inertia each joint seems to have."""
        return tuple(t / a for t, a in zip(self.torque, self.acceleration, strict=True))


def fit_scales(v: np.ndarray, a: np.ndarray, tau: np.ndarray) -> Scales:
    """Measure the sizes on training data of shape (n, dof); joints that never move or push count as size 1."""
    speed, acceleration = (np.sqrt(np.mean(x**2, axis=0)) for x in (v, a))
    return Scales(_sizes(speed), _sizes(acceleration), _sizes(tau.std(axis=0)))


def _sizes(values: np.ndarray) -> tuple[float, ...]:
    return tuple(float(x) if x > 1e-9 else 1.0 for x in values)
