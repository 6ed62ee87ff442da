"""What a plant may hide, how large, and where it acts: on the command, in the servo, or at the joint."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, log

import numpy as np

ENCODER = 2.0 * np.pi / 4096.0  # [rad]
STILL = 2e-3  # [rad/s] below which break-away friction acts
DAMPING = 0.05  # of the critical one, of a spring between motor and link
LISTED: dict[str, tuple[str, float, float]] = {  # effect → parameter, least and greatest value for kp = 8 N m/rad
    "command_delay": ("T", 0.01, 0.06),
    "dead_band": ("b", 2.0 * ENCODER, 0.05),  # the least of each is a static error of two encoder steps
    "gain_error": ("kp", 4.0, 7.0),
    "position_bias": ("delta", 2.0 * ENCODER, 0.05),
    "coulomb_friction": ("Fc", 0.055, 0.2),
    "viscous_friction": ("Fv", 0.2, 0.7),
    "static_friction": ("Fs", 0.025, 0.3),
    "payload": ("m", 0.03, 0.25),
    "joint_spring": ("k", 0.025, 1.0),
    "joint_elasticity": ("K", 30.0, 64.0),  # bent by two encoder steps by 0.2 N m; unstable if softer
    "backlash": ("b", 2.0 * ENCODER, 0.03),
}
UNLISTED: dict[str, tuple[str, float, float]] = {
    "torque_ripple": ("A", 0.1, 0.2),
    "passing_push": ("A", 0.05, 0.15),
    "fading_gain": ("share", 0.15, 0.4),
    "hardening_spring": ("k3", 0.3, 0.8),
}
UNSEEN = 5.0  # times as large is a play that starts behind the encoder: at rest the motor's encoder shows none of it
YIELDING = ("joint_elasticity", "backlash")
TORQUES = ("gain_error", "coulomb_friction", "viscous_friction", "static_friction", "joint_spring", "joint_elasticity")
SCALED = (*TORQUES, "torque_ripple", "passing_push", "hardening_spring")  # as the gain of the servo
LAW_KEY = {"gain_error": "kp", "coulomb_friction": "coulomb", "viscous_friction": "viscous"}
PERIOD = 7.0  # [s] of a passing push
SIDES = ("motor", "link")


@dataclass(frozen=True)
class Cause:
    """What a plant hides: an effect at a joint and its true value; side: of the encoder, where motor and link part."""

    effect: str
    joint: int
    parameter: str
    value: float
    side: str = ""


def draw_cause(rng: np.random.Generator, effect: str, joint: int, factor: float, side: str) -> Cause:
    """A cause of a size drawn evenly on a logarithmic scale; factor: of the servo's gain over 8 N m/rad."""
    parameter, low, high = (LISTED | UNLISTED)[effect]
    if effect == "backlash" and side == "motor":
        low, high = UNSEEN * low, 0.05
    value = exp(rng.uniform(log(low), log(high))) * (factor if effect in SCALED else 1.0)
    digits = 3 if effect == "command_delay" else 4  # whole steps of the engine
    return Cause(effect, joint, parameter, round(value, digits), side if effect in YIELDING else "")


def law_with(law: dict[str, float], cause: Cause | None, joint: int) -> dict[str, float]:
    """The servo's law at a joint, with what of the cause is a parameter of it."""
    if cause is None or cause.joint != joint or cause.effect not in LAW_KEY:
        return dict(law)
    return law | {LAW_KEY[cause.effect]: cause.value}


def error_felt(cause: Cause, asked: float, q: float, at: float) -> float:
    """The command error on which the servo of the cause's joint acts, `at` of the recording's length (0 to 1) [rad]."""
    error = asked - q
    if cause.effect == "dead_band":
        return float(np.sign(error)) * max(abs(error) - cause.value, 0.0)
    if cause.effect == "position_bias":
        return error - cause.value
    return error * (1.0 - cause.value * at) if cause.effect == "fading_gain" else error


def torque_beside(cause: Cause, q: float, time: float) -> float:
    """Torque of the cause at its joint, beside servo and friction [N m]."""
    if cause.effect == "joint_spring":
        return -cause.value * q
    if cause.effect == "torque_ripple":
        return cause.value * float(np.sin(8.0 * q))
    if cause.effect == "passing_push":
        return cause.value * float(np.sin(2.0 * np.pi * time / PERIOD))
    return -cause.value * q**3 if cause.effect == "hardening_spring" else 0.0


def dry_friction(cause: Cause | None, law: dict[str, float], joint: int, v: float) -> float:
    """Greatest dry friction of a joint at a speed [N m]."""
    held = cause is not None and cause.effect == "static_friction" and cause.joint == joint and abs(v) < STILL
    return law["coulomb"] + (cause.value if held and cause is not None else 0.0)
