"""Transmissions with a second mass: a motor that a spring, with or without a gap, ties to its link."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Gear:
    """Motor and link of one joint, tied by a damped spring behind a gap.

    Args:
        joint: index.
        stiffness: [N m/rad].
        damping: [N m s/rad], while the spring is bent.
        rotor: inertia of the motor about the joint [kg m²].
        half_gap: [rad].
    """

    joint: int
    stiffness: float
    damping: float
    rotor: float
    half_gap: float = 0.0

    def torque(self, bend: float, rate: float) -> float:
        """Torque on the link [N m] for motor angle less link angle [rad] and its rate [rad/s]."""
        if bend > self.half_gap:  # a flank pushes and never sticks
            push = self.stiffness * (bend - self.half_gap) + self.damping * rate
            return max(push, 0.0) if self.half_gap else push
        if bend < -self.half_gap:
            push = self.stiffness * (bend + self.half_gap) + self.damping * rate
            return min(push, 0.0) if self.half_gap else push
        return self.damping * rate if not self.half_gap else 0.0
