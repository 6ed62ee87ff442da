"""Dry friction of a gear: F = Fc + Fs g + (K |load| + K_m |τ_m| + K₂ load²)(1 + s g), g = exp(−(v/v_s)²).

K is by the direction of power: while the motor moves the load (sign(v) load > 0) it is K_driving, while the load drives
the motor K_driven. A gear with K_driven ≥ 1 holds its load by itself. Teeth are pressed by the motor's torque τ_m on
one side and by the load on the other: K_m = K is friction in proportion to both; s is what it is larger near rest,
where teeth run dry. Source: Duclusaud et al. 2025 (Better Actuator Models).
"""

from __future__ import annotations

from math import exp

from numba import njit

from lagnet.servos.parameters import (
    COULOMB,
    DRIVEN,
    DRIVING,
    LOAD_MOTOR,
    LOAD_SQUARED,
    LOAD_STRIBECK,
    STATIC,
    STRIBECK_SPEED,
)


@njit(cache=True, error_model="numpy")
def falls_with_speed(p):  # pragma: no cover - compiled
    """Whether dry friction is larger at rest than in motion, so that a joint breaks away."""
    return p[STATIC] != 0.0 or p[LOAD_STRIBECK] != 0.0


@njit(cache=True, error_model="numpy")
def dry_friction(p, v, load, motor, side):  # pragma: no cover - compiled
    """Greatest dry friction against motion to a side (±1) at speed v under a load and a motor torque [N m]."""
    near_rest = 0.0
    if v == 0.0:
        near_rest = 1.0
    elif p[STRIBECK_SPEED] > 0.0 and falls_with_speed(p):
        near_rest = exp(-((v / p[STRIBECK_SPEED]) ** 2))
    size = abs(load)
    gear = (p[DRIVING] if side * load > 0.0 else p[DRIVEN]) * size + p[LOAD_SQUARED] * size * size
    gear += p[LOAD_MOTOR] * abs(motor)
    return p[COULOMB] + p[STATIC] * near_rest + gear * (1.0 + p[LOAD_STRIBECK] * near_rest)
