"""Torque of a position controller: x = clip(r γ (kp e + I) − r kd v, ±r kp E), clip(x / (1 + σ |x|), ±r τ_max).

e is behind a dead band; kp E is full duty; r is the share of the nominal voltage, γ the gains of a recording over those
of the law.
"""

from __future__ import annotations

from numba import njit

from lagnet.servos.parameters import DEAD_BAND, FULL_ERROR, KD, KP, LIMIT, SATURATION


@njit(cache=True, error_model="numpy")
def outside_dead_band(error, width):  # pragma: no cover - compiled
    """The part of the error beyond ± width [rad]."""
    if error > width:
        return error - width
    if error < -width:
        return error + width
    return 0.0


@njit(cache=True, error_model="numpy")
def controller_torque(p, error, integral, v, ratio, gain):  # pragma: no cover - compiled
    """Torque at a command error and speed, and the slopes −∂τ/∂q, −∂τ/∂v, zero in saturation or dead band."""
    beyond = outside_dead_band(error, p[DEAD_BAND])
    torque = ratio * (gain * (p[KP] * beyond + integral) - p[KD] * v)
    full = ratio * p[KP] * p[FULL_ERROR]
    within = abs(torque) <= full
    torque = min(max(torque, -full), full)
    slope, limit = ratio, ratio * p[LIMIT]
    if p[SATURATION] != 0.0:
        lost = 1.0 + p[SATURATION] * abs(torque)
        torque, slope = torque / lost, ratio / (lost * lost)
    if abs(torque) > limit or not within:
        return min(max(torque, -limit), limit), 0.0, 0.0
    stiffness = gain * slope * p[KP] if beyond != 0.0 or p[DEAD_BAND] == 0.0 else 0.0
    return torque, stiffness, slope * p[KD]
