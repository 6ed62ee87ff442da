"""What may be hidden in a MuJoCo arm, and how large: MuJoCo's own friction, damping, armature and bodies where it has
them, a term of the step where not, a change of what is written down where the sensor is at fault."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

ALONE = (  # the effects that are drawn, one a plant in turn
    "viscous_friction",
    "coulomb_friction",
    "asymmetric_friction",
    "stribeck_friction",
    "quadratic_drag",
    "rotor_inertia",
    "payload",
    "link_inertia",
    "gravity_tilt",
    "joint_spring",
    "torque_ripple",
    "torque_gain",
    "torque_offset",
    "encoder_offset",
    "time_delay",
    "joint_elasticity",
    "saturation",
    "contact_force",
)
UNLISTED = ("belt", "friction_of_another_joint", "wear_along_the_path")
BESIDE = ("viscous_friction", "coulomb_friction", "payload")  # one of them, beside three of five
WHOLE_ARM = ("payload", "gravity_tilt", "contact_force")
NEEDS_TORQUE = ("encoder_offset", "torque_gain", "saturation", "joint_elasticity", "gravity_tilt")


@dataclass(frozen=True)
class Hidden:
    """One cause.

    Args:
        effect: its name in the catalogue, or one of UNLISTED.
        joint: index; None for the whole arm.
        values: its numbers, SI units.
    """

    effect: str
    joint: int | None
    values: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Usual:
    """What an arm does when nothing is hidden, each of shape (dof,): what sizes are drawn against.

    Args:
        torque: rms [N m]; most: its 93 % quantile; speed, acceleration, spread: rms of v and a, deviation of q.
        centre: mean of q; inertia: diagonal of the mass matrix there; mass: of the whole arm [kg].
    """

    torque: np.ndarray
    most: np.ndarray
    speed: np.ndarray
    acceleration: np.ndarray
    spread: np.ndarray
    centre: np.ndarray
    inertia: np.ndarray
    mass: float


def drawn(effect: str, joint: int, usual: Usual, rng: np.random.Generator) -> Hidden:
    """An effect whose torque is between 5 and 40 % of the joint's."""
    share = float(np.exp(rng.uniform(np.log(0.05), np.log(0.4))))
    torque = share * max(float(usual.torque[joint]), 0.02 * float(usual.torque.max()))
    values = SIZES[effect](torque, share, joint, usual, rng)
    return Hidden(effect, None if effect in WHOLE_ARM else joint, {k: float(x) for k, x in values.items()})


Draw = Callable[[float, float, int, Usual, np.random.Generator], dict[str, Any]]


def _sign(rng: np.random.Generator) -> float:
    return float(rng.choice([-1.0, 1.0]))


SIZES: dict[str, Draw] = {
    "viscous_friction": lambda t, s, j, u, r: {"Fv": t / u.speed[j]},
    "coulomb_friction": lambda t, s, j, u, r: {"Fc": t},
    "asymmetric_friction": lambda t, s, j, u, r: {"plus": 1.3 * t, "minus": 0.6 * t, "sharp": 0.003 * u.speed[j]},
    "stribeck_friction": lambda t, s, j, u, r: {
        "Fc": t,
        "more": 0.8 * t,
        "vs": r.uniform(0.05, 0.25) * u.speed[j],
        "sharp": 0.01 * u.speed[j],
    },
    "quadratic_drag": lambda t, s, j, u, r: {"c": t / u.speed[j] ** 2},
    "rotor_inertia": lambda t, s, j, u, r: {"Ia": t / u.acceleration[j]},
    "payload": lambda t, s, j, u, r: {"m": u.mass * r.uniform(0.02, 0.1)} | _point(r),
    "link_inertia": lambda t, s, j, u, r: {"factor": 1.0 + _sign(r) * (0.15 + s / 2)},
    "gravity_tilt": lambda t, s, j, u, r: {k: _sign(r) * r.uniform(0.02, 0.1) for k in ("roll", "pitch")},
    "joint_spring": lambda t, s, j, u, r: {"k": t / u.spread[j], "q0": u.centre[j] + r.uniform(-0.5, 0.5)},
    "torque_ripple": lambda t, s, j, u, r: {"A": t, "N": r.choice([4, 6, 8, 12, 15]), "phase": r.uniform(0.0, 6.0)},
    "torque_gain": lambda t, s, j, u, r: {"g": 1.0 + _sign(r) * min(s, 0.25)},
    "torque_offset": lambda t, s, j, u, r: {"b": _sign(r) * t},
    "encoder_offset": lambda t, s, j, u, r: {"dq": _sign(r) * r.uniform(0.01, 0.05)},
    "time_delay": lambda t, s, j, u, r: {"T": r.uniform(0.005, 0.03)},
    "joint_elasticity": lambda t, s, j, u, r: {
        "k": 3.0 * u.most[j] / r.uniform(0.01, 0.05),
        "rotor": max(1e-3, 0.3 * u.inertia[j]),
    },
    "saturation": lambda t, s, j, u, r: {"most": u.most[j]},
    "contact_force": lambda t, s, j, u, r: dict(
        zip("xyz", r.normal(size=3) * r.uniform(0.3, 0.9) * u.mass, strict=True)
    ),
    "belt": lambda t, s, j, u, r: _belt(t, j, u, int(r.integers(1, u.torque.size))),
    "friction_of_another_joint": lambda t, s, j, u, r: {
        "size": t,
        "other": r.integers(1, u.torque.size),
        "sharp": 0.01 * u.speed[j],
    },
    "wear_along_the_path": lambda t, s, j, u, r: {"size": t / u.speed[j]},
}


def _belt(torque: float, joint: int, usual: Usual, other: int) -> dict[str, float]:
    """Taut at the middle of the motion: one that is drawn tight throughout is a constant torque, which is listed."""
    ends = usual.centre[(joint + other) % usual.torque.size], usual.centre[joint]
    return {"size": torque, "other": other, "slack": float(ends[0] - 0.5 * ends[1])}


def _point(rng: np.random.Generator) -> dict[str, float]:
    return dict(zip(("cx", "cy", "cz"), rng.uniform(-0.05, 0.08, 3), strict=True))
