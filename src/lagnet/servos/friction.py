"""Dry friction of a gear: F = Fc + Fs exp(−(v/v_s)²) + K |load| + K_m |τ_m| + K₂ load², K by the direction of power.

While the motor moves the load (sign(v) load > 0) K is K_driving, while the load drives the motor K_driven. A gear with
K_driven ≥ 1 holds its load by itself. Teeth are pressed by the motor's torque τ_m on one side and by the load on the
other: K_m = K is friction in proportion to both. Source: Duclusaud et al. 2025 (Better Actuator Models).
"""

from __future__ import annotations

from math import exp

from numba import njit

from lagnet.servos.parameters import COULOMB, DRIVEN, DRIVING, LOAD_MOTOR, LOAD_SQUARED, STATIC, STRIBECK_SPEED


@njit(cache=True, error_model="numpy")
def dry_friction(p, v, load, motor, side):  # pragma: no cover - compiled
    """Greatest dry friction against motion to a side (±1) at speed v under a load and a motor torque [N m]."""
    bound = p[COULOMB]
    if p[STATIC] != 0.0:
        if v == 0.0:
            bound += p[STATIC]
        elif p[STRIBECK_SPEED] > 0.0:
            bound += p[STATIC] * exp(-((v / p[STRIBECK_SPEED]) ** 2))
    size = abs(load)
    bound += (p[DRIVING] if side * load > 0.0 else p[DRIVEN]) * size + p[LOAD_SQUARED] * size * size
    return bound + p[LOAD_MOTOR] * abs(motor)
