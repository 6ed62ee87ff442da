"""Dry surfaces that truly stick: the level that each can hold, by speed, load, angle or time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np


class Surface(Protocol):
    """Dry friction against a speed w = Σ weight · v of some joints."""

    @property
    def ways(self) -> tuple[tuple[int, float], ...]:
        """Joints and their weights."""
        ...

    def level(self, t: float, q: np.ndarray, w: float, side: float, load: np.ndarray) -> float:
        """Torque that it holds [N m] at speed w towards one side, under joint loads [N m]."""
        ...


@dataclass(frozen=True)
class Plain:
    """Kinetic levels of both directions and a static excess that fades with speed."""

    ways: tuple[tuple[int, float], ...]
    forward: float
    backward: float
    excess: float = 0.0
    fade: float = 1.0
    exponent: float = 2.0

    def level(self, t: float, q: np.ndarray, w: float, side: float, load: np.ndarray) -> float:
        kinetic = self.forward if side > 0 else self.backward
        if not self.excess:
            return kinetic
        return kinetic + self.excess * float(np.exp(-(abs(w / self.fade) ** self.exponent)))


@dataclass(frozen=True)
class Loaded:
    """Teeth that rub the harder, the more torque they carry."""

    ways: tuple[tuple[int, float], ...]
    share: float  # [–]

    def level(self, t: float, q: np.ndarray, w: float, side: float, load: np.ndarray) -> float:
        return self.share * abs(float(load[self.ways[0][0]]))


@dataclass(frozen=True)
class Worn:
    """A level that depends on the angle: a scored or greased stretch of the surface."""

    ways: tuple[tuple[int, float], ...]
    mean: float  # [N m]
    swing: float  # of the mean
    turns: float  # periods per 2π of the joint
    phase: float

    def level(self, t: float, q: np.ndarray, w: float, side: float, load: np.ndarray) -> float:
        return self.mean * (1 + self.swing * float(np.sin(self.turns * q[self.ways[0][0]] + self.phase)))


@dataclass(frozen=True)
class Warming:
    """A level that falls as the grease warms up, anew in each recording."""

    ways: tuple[tuple[int, float], ...]
    cold: float  # [N m]
    warm: float  # [N m]
    time: float  # [s]

    def level(self, t: float, q: np.ndarray, w: float, side: float, load: np.ndarray) -> float:
        return self.warm + (self.cold - self.warm) * float(np.exp(-t / self.time))
