"""One joint of a motion problem as a regression: data to fit and to validate on, nominal law, sizes and limits."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from lagnet.diagnosis.motion.joint.fitting import JointData
from lagnet.servos.effect import Scales
from lagnet.servos.parameters import NAMES


@dataclass(frozen=True)
class SelectionLimits:
    """Limits at which an effect is named on motion.

    Args:
        errors: least gain on held-out motion in standard errors over blocks.
        gain: least gain of the held-out score, 0.03 for errors 3 % smaller.
        tie: difference of two rivals in standard errors below which they are tied.
        steps: least change of the predicted motion over `JointCase.floor`, half an encoder step; twice it in one block.
        change: least relative change of a parameter from its nominal value.
        remainder: greatest error that names may leave, over that without them, where it is also
        unexplained: so many times `JointCase.floor`.
        trend: greatest change of a parameter from the middle of recordings to their ends, in shares of what its effect
            changes, where that is more than its scatter.
    """

    errors: float = 3.0
    gain: float = 0.03
    tie: float = 2.0
    steps: float = 1.0
    change: float = 0.05
    remainder: float = 0.6
    unexplained: float = 4.0
    trend: float = 0.2


@dataclass(frozen=True, eq=False)
class JointCase:
    """One joint: its motion to fit and to validate on, its nominal law, and typical sizes.

    Args:
        fit, validation: disjoint windows of the motion.
        moved_by_load: whether the load moved the joint against its motor, so that friction per load is below 1.
        folds: further pairs of them, so that every window is for validation once; none where there is enough motion.
        law: the nominal law.
        start: the law of the equation error, with every plain effect in it.
        scale_is_set: whether loads determine the scale of torques; else torques are known as ratios to kp.
        base: law parameters that are always free, those of a servo without a nominal law.
        scales: typical torque, speed, error, inertia.
        floor: resolution of the error [rad].
        excited: effects that the motion excites.
    """

    fit: JointData
    validation: JointData
    law: np.ndarray
    start: np.ndarray
    scale_is_set: bool
    base: tuple[tuple[str, ...], ...]
    scales: Scales
    floor: float
    excited: tuple[str, ...]
    limits: SelectionLimits = field(default_factory=SelectionLimits)
    folds: tuple[tuple[JointData, JointData], ...] = ()
    moved_by_load: bool = False


def sizes_of(scales: Scales) -> dict[str, float]:
    """Typical size of every law parameter, by which it is scaled."""
    torque, speed = scales.torque, scales.speed
    sizes = dict.fromkeys(NAMES, 0.1 * torque)
    sizes |= {
        "kp": 0.3 * scales.kp,
        "kd": 0.1 * torque / speed,
        "viscous": 0.1 * torque / speed,
        "back_emf": 0.1 * torque / speed,
    }
    sizes |= {"bias": 0.05 * scales.error, "dead_band": 0.1 * scales.error, "delay": scales.sample}
    sizes |= {"rotor": 0.3 * scales.inertia + 1e-4 * scales.kp, "quadratic": 0.1 * torque / speed**2}
    shares = ("load_driving", "load_driven", "load_motor", "load_gain")
    sizes |= dict.fromkeys(shares, 0.2) | {"load_stribeck": 0.3}
    sizes |= dict.fromkeys(("load_squared", "saturation"), 0.1 / max(torque, 1e-9))
    return sizes | {
        "spring": 0.1 * scales.kp,
        "spring_rest": 0.2,
        "stiffness": scales.kp,
        "twist_damping": 0.02 * torque / speed,
        "gap": 0.1 * scales.error,
        "stribeck_speed": 0.2 * speed,
        "torque_limit": torque,
    }
