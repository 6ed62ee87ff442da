"""Functions of a joint's motion in which friction, rotors, springs and ties between joints are linear: Φ(q, v, a).

A weighted sum of them is a torque that recordings determine without a name for its cause: `dry` and `bristle` terms
together are friction that builds up over several distances, `viscous`, `dry` and bends of speed a curve over speed,
`load` friction that grows with the torque on the joint, waves over position a torque or a friction that changes along
the joint's range. Sources: Bittencourt 2012 (load and speed), Canudas de Wit 1995 (bristles), Gautier 1990 (rotors,
ties).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lagnet.effects.bristle import bristle
from lagnet.effects.motion import Motion
from lagnet.effects.rest import blurred_sign, resting
from lagnet.types import Trajectory

HALF_WAVES = {"position": 8, "viscous_path": 3, "dry_path": 3}  # over the range of a joint, of its torque and friction
OVER_POSITION = {f"{what}_{k}": (what, k) for what, most in HALF_WAVES.items() for k in range(1, most + 1)}
"""Kinds of functions that change over the range of a joint: what the wave is multiplied with, and its half waves."""


@dataclass(frozen=True)
class MotionTerm:
    """One function of the motion.

    Args:
        kind: key of `KINDS`.
        joint: index of the joint that feels it.
        scale: what the function is stretched by: a speed [rad/s], a distance [rad]; 1 where there is nothing.
        other: index of the joint before that it ties to; None for a function of one joint.
        centre: position about which a wave is stretched [rad]; 0 for all else.
    """

    kind: str
    joint: int
    scale: float = 1.0
    other: int | None = None
    centre: float = 0.0

    @property
    def rows(self) -> tuple[int, ...]:
        """Joints whose torque it adds to."""
        return (self.joint,) if self.kind not in MUTUAL or self.other is None else (self.joint, self.other)

    def at(self, row: int, motion: Motion, load: Trajectory, rest: Rest | None) -> np.ndarray:
        """Torque at a joint for a weight of one, shape (n,).

        Args:
            row: one of `rows`.
            motion: samples in the order of time, or not.
            load: shape (n, dof), torque of the rigid bodies [N m].
            rest: what happens at rest; None where samples stand for themselves, and what has memory slides steadily.
        """
        mine, theirs = (self.joint, self.other) if row == self.joint else (self.other, self.joint)
        return KINDS[self.kind](Seen(motion, load, int(mine or 0), theirs, self.scale, rest, self.centre))


@dataclass(frozen=True, eq=False)
class Rest:
    """When joints rest and what of their dry friction stays, each of shape (dof,).

    Args:
        speed: below which a joint rests [rad/s].
        held: share of what bent bristles hold that stays at rest, 0 to 1.
    """

    speed: np.ndarray
    held: np.ndarray


@dataclass(frozen=True)
class Seen:
    """What a function is given: the motion, the load, the joint that feels it, its partner, scale, rest and centre."""

    motion: Motion
    load: Trajectory
    joint: int
    other: int | None
    scale: float
    rest: Rest | None
    centre: float = 0.0

    @property
    def speed(self) -> np.ndarray:
        """Speed of the joint, shape (n,)."""
        return self.motion.v[:, self.joint]

    @property
    def partner(self) -> int:
        """The other joint of a pair."""
        return self.joint if self.other is None else self.other

    def direction(self, joint: int) -> np.ndarray:
        """s(v) of a joint, shape (n,)."""
        m = self.motion
        return blurred_sign(m.v[:, joint], m.slow[joint], m.straight is not None and bool(m.straight[joint]))


def _bristle(seen: Seen) -> np.ndarray:
    """How far friction that builds up over a distance is behind the direction of motion: z − s(v)."""
    if seen.rest is None:
        return np.zeros(len(seen.motion.q))
    motion, j = seen.motion, seen.joint
    behind = bristle(motion.q[:, j], seen.scale) - seen.direction(j)
    still = resting(motion.time, motion.v[:, j], seen.rest.speed[j])
    return np.where(still, seen.rest.held[j] * behind, behind)


def _lag(seen: Seen) -> np.ndarray:
    """v(t − T) − v(t): how far speed was behind a moment ago, −T a for a short T; nothing where samples have no order.

    Torque in phase with −a is no inertia: a drive that answers late to friction shows it.
    """
    if seen.rest is None:
        return np.zeros(len(seen.motion.q))
    time = seen.motion.time
    return np.interp(time - seen.scale, time, seen.speed) - seen.speed


def _relative(seen: Seen, sense: float) -> np.ndarray:
    """Direction of the speed v_j ± v_k of what turns with both joints, as this joint feels it."""
    motion, blur = seen.motion, np.hypot(seen.motion.slow[seen.joint], seen.motion.slow[seen.partner])
    return np.tanh((seen.speed + sense * motion.v[:, seen.partner]) / blur)


def wave(order: int, position: np.ndarray, centre: float, scale: float) -> np.ndarray:
    """cos(k π (u + 1) / 2) of u = (q − centre) / scale, constant beyond u = ±1: what was not seen is not told."""
    return np.cos(order * np.pi / 2.0 * (np.clip((position - centre) / scale, -1.0, 1.0) + 1.0))


def _along(order: int, times: Callable[[Seen], np.ndarray]) -> Callable[[Seen], np.ndarray]:
    """A wave over the joint's position times a function of its motion."""
    return lambda x: wave(order, x.motion.q[:, x.joint], x.centre, x.scale) * times(x)


ALONG: dict[str, Callable[[Seen], np.ndarray]] = {
    "position": lambda x: np.ones(len(x.motion.q)),
    "viscous_path": lambda x: x.speed,
    "dry_path": lambda x: x.direction(x.joint),
}
BENDS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "early_bend": lambda u: np.tanh(u / 0.1),
    "late_bend": lambda u: np.tanh(u / 0.3),
    "drag": lambda u: u * np.abs(u),
}
"""Curves over speed in parts of its usual largest value."""


def bend(shape: Callable[[np.ndarray], np.ndarray], u: np.ndarray, sign: np.ndarray) -> np.ndarray:
    """What a curve over speed u has beyond a straight line and a step, constant beyond u = 1, shape (n,).

    Viscous and dry friction thus stay those that fit by themselves, and faster motion is not told what slow motion
    cannot know.
    """
    grid = np.linspace(0.0, 1.0, 101)[1:]
    (slope, step), *_ = np.linalg.lstsq(np.column_stack([grid, np.ones_like(grid)]), shape(grid), rcond=None)
    within = np.clip(u, -1.0, 1.0)
    return shape(within) - slope * within - step * sign


KINDS: dict[str, Callable[[Seen], np.ndarray]] = {
    "viscous": lambda x: x.speed,
    "dry": lambda x: x.direction(x.joint),
    "offset": lambda x: np.ones(len(x.motion.q)),
    "rotor": lambda x: x.motion.a[:, x.joint],
    **{
        kind: (lambda shape: lambda x: bend(shape, x.speed / x.scale, x.direction(x.joint)))(f)
        for kind, f in BENDS.items()
    },
    "load": lambda x: np.abs(x.load[:, x.joint]) * x.direction(x.joint),
    "gain": lambda x: x.load[:, x.joint],
    "bristle": _bristle,
    "lag": _lag,
    "spring": lambda x: x.motion.q[:, x.joint],
    **{kind: _along(order, ALONG[what]) for kind, (what, order) in OVER_POSITION.items()},
    "cross_viscous": lambda x: x.motion.v[:, x.partner],
    "cross_inertia": lambda x: x.motion.a[:, x.partner],
    "cross_dry_sum": lambda x: _relative(x, 1.0),
    "cross_dry_difference": lambda x: _relative(x, -1.0),
}
MUTUAL = ("cross_viscous", "cross_inertia", "cross_dry_sum", "cross_dry_difference")  # on both joints of a pair
INERTIA = ("rotor", "cross_inertia")  # proportional to acceleration: part of the mass matrix
