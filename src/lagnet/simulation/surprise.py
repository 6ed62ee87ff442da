"""Draws physics to hide in an arm: something plausible, of a size that matters, at a joint that can show it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from lagnet.effects.catalogue import effect_named
from lagnet.rigid_body.robot import Robot
from lagnet.simulation.injection import InjectedEffect

SHARE = (0.15, 0.4)  # of the joint's gravity torque
TYPICAL_SPEED, TYPICAL_ACCELERATION = 0.8, 2.0  # [rad/s], [rad/s²]
POSES = 200


def draw_surprise(robot: Robot, seed: int, count: int = 2) -> tuple[InjectedEffect, ...]:
    """Effects of different kinds at joints that carry weight, drawn from a seed."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(-1.5, 1.5, (POSES, robot.n_dof))
    level = np.sqrt(np.mean(robot.gravity_torque(q) ** 2, axis=0))
    loaded = np.flatnonzero(level > 0.05 * level.max())
    names = rng.permutation(sorted(RECIPES))[:count]
    out = []
    for name in names:
        joint = int(rng.choice(loaded))
        size = rng.uniform(*SHARE) * level[joint]
        law = effect_named(str(name))
        out.append(InjectedEffect(law, None if law.whole_arm else joint, RECIPES[str(name)](float(size), rng)))
    return tuple(out)


def _payload(size: float, rng: np.random.Generator) -> dict[str, float]:
    mass = float(rng.uniform(0.8, 2.5))
    moment = 0.4 * mass * 0.05**2  # a ball of 5 cm
    values = {"m": mass, "cx": 0.0, "cy": float(rng.uniform(-0.03, 0.03)), "cz": float(rng.uniform(0.03, 0.1))}
    return values | {"Ixx": moment, "Ixy": 0.0, "Iyy": moment, "Ixz": 0.0, "Iyz": 0.0, "Izz": moment}


RECIPES: dict[str, Callable[[float, np.random.Generator], dict[str, float]]] = {
    "viscous_friction": lambda size, rng: {"Fv": size / TYPICAL_SPEED},
    "coulomb_friction": lambda size, rng: {"Fc": size},
    "stribeck_friction": lambda size, rng: {"Fc": size, "Fs": 0.8 * size, "vs": float(rng.uniform(0.1, 0.2))},
    "rotor_inertia": lambda size, rng: {"Ia": size / TYPICAL_ACCELERATION},
    "joint_spring": lambda size, rng: {"k": size, "q0": float(rng.uniform(-0.5, 0.5))},
    "payload": _payload,
}
