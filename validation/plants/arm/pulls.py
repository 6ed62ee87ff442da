"""Forces that depend on where a joint is, how fast, and when: drag, springs, cogging, and friction with memory.

Every pull adds what the links or the motor feel to `force` and its derivative by speed to `slope`, in place; arrays
have shape (dof,). A drag has a negative force along the motion and a positive slope.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np


class Pull(Protocol):
    """One cause of joint torque; called once a step, in order of time."""

    def reset(self) -> None:
        """Forget the run before."""
        ...

    def add(self, t: float, q: np.ndarray, v: np.ndarray, force: np.ndarray, slope: np.ndarray) -> None:
        """Add torque [N m] and its slope [N m s/rad] at time t [s]."""
        ...


@dataclass
class Drag:
    """Drag c |v|^(power-1) v of one joint: 1 viscous, 2 quadratic, 3 cubic."""

    joint: int
    c: float
    power: float = 1.0

    def reset(self) -> None: ...

    def add(self, t: float, q: np.ndarray, v: np.ndarray, force: np.ndarray, slope: np.ndarray) -> None:
        speed = float(v[self.joint])
        rate = self.c * abs(speed) ** (self.power - 1)
        force[self.joint] -= rate * speed
        slope[self.joint] += self.power * rate


@dataclass
class Field:
    """Torque of one joint that depends on the angles and on time alone: springs, cogging, cables, disturbances."""

    joint: int
    law: Callable[[float, np.ndarray], float]

    def reset(self) -> None: ...

    def add(self, t: float, q: np.ndarray, v: np.ndarray, force: np.ndarray, slope: np.ndarray) -> None:
        force[self.joint] += self.law(t, q)


@dataclass
class Coupling:
    """Torque of all joints by any law of time, angles and speeds, without a slope."""

    law: Callable[[float, np.ndarray, np.ndarray], np.ndarray]

    def reset(self) -> None: ...

    def add(self, t: float, q: np.ndarray, v: np.ndarray, force: np.ndarray, slope: np.ndarray) -> None:
        force += self.law(t, q, v)


@dataclass
class MaxwellSlip:
    """Friction with memory as sliders on springs side by side (generalised Maxwell slip).

    Args:
        joint: index.
        stiffness: shape (k,), of the springs [N m/rad].
        level: shape (k,), torque at which each slider slips [N m].
    """

    joint: int
    stiffness: np.ndarray
    level: np.ndarray
    _held: np.ndarray | None = field(default=None, init=False)
    _last: float = field(default=0.0, init=False)

    def reset(self) -> None:
        self._held = None

    def add(self, t: float, q: np.ndarray, v: np.ndarray, force: np.ndarray, slope: np.ndarray) -> None:
        angle = float(q[self.joint])
        if self._held is None:
            self._held, self._last = np.zeros_like(self.level), angle
        trial = self._held + self.stiffness * (angle - self._last)
        self._held, self._last = np.minimum(np.maximum(trial, -self.level), self.level), angle
        force[self.joint] -= float(self._held.sum())
