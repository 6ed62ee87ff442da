"""Motor and link of one joint as two inertias that a spring or a play joins: one step, with exact stick and contact.

Over a step of h, with w and v the speeds of motor and link and P the impulse that passes from one to the other,

    B w' + C v' = s − P − h F sign(w'),    A v' = r + P.

A spring gives P = e + E (w' − v') by its twist at mid-step. A play without a spring has hard stops: inside it P = 0,
and a motor that would leave it arrives at its edge and stays there, an inelastic impact. Both are linear once it is
known whether they touch, so that one equation for w' with dry friction is left, solved as for a rigid joint.
Sources: De Luca & Book 2016 (flexible joints); Stewart & Trinkle 1996.
"""

from __future__ import annotations

from numba import njit

from lagnet.rollout.damper import explicit_share
from lagnet.servos.friction import dry_friction
from lagnet.servos.parameters import (
    ENCODER_SIDE,
    GAP,
    OFFSET,
    QUADRATIC,
    ROTOR,
    STATIC,
    STIFFNESS,
    TWIST_DAMPING,
    VISCOUS,
)

LEAST_ROTOR = 0.05  # of the link's inertia: a motor without one has no motion of its own
AT_EDGE = 1e-12  # [rad]


@njit(cache=True, error_model="numpy")
def yields(p):  # pragma: no cover - compiled
    """Whether motor and link of a joint are apart."""
    return p[STIFFNESS] > 0.0 or p[GAP] > 0.0


@njit(cache=True, error_model="numpy")
def twist_at_rest(p, load):  # pragma: no cover - compiled
    """Motor less link position while the transmission holds a load [rad]."""
    side = 1.0 if load > 0.0 else (-1.0 if load < 0.0 else 0.0)
    return side * p[GAP] + (load / p[STIFFNESS] if p[STIFFNESS] > 0.0 else 0.0)


@njit(cache=True, error_model="numpy")
def motor_row(p, w, v, torque, stiff, damp, brake, mass, h):  # pragma: no cover - compiled
    """B, C, s and the motor's inertia I; torque, stiff and damp of the controller at its own encoder."""
    inertia = max(p[ROTOR], LEAST_ROTOR * mass)
    damping = brake + p[VISCOUS] + p[QUADRATIC] * abs(w)
    b, c, drive = inertia, 0.0, torque + p[OFFSET]
    if p[ENCODER_SIDE] > 0.5:
        c = 0.5 * h * damp + 0.25 * h * h * stiff
        drive += 0.5 * damp * v - 0.25 * h * stiff * v
    else:
        damping += damp
        b += 0.25 * h * h * stiff
        drive += damp * w - 0.25 * h * stiff * w
    early = explicit_share(damping, inertia, h)
    return b + h * (1.0 - early) * damping, c, inertia * w + h * (drive - early * damping * w), inertia


@njit(cache=True, error_model="numpy")
def joined_speeds(p, row, a, r, twist, w, v, load, motor, h):  # pragma: no cover - compiled
    """Speeds w' of the motor and v' of the link, and the side on which hard stops touch, 0 where none does.

    row: of `motor_row`; a, r: of the link; twist: θ − q; load, motor: torques on which friction depends.
    """
    b, c, s, inertia = row
    alone = r / a
    free = _motor_speed(p, b, s - c * alone, s - c * alone - inertia * w, w, load, motor, h)
    gap, stiffness = p[GAP], p[STIFFNESS]
    ahead = twist + 0.5 * h * ((w - v) + (free - alone))
    side = 1.0 if ahead > 0.0 else -1.0
    if gap > 0.0 and abs(ahead) <= gap:
        return free, alone, 0.0
    if stiffness <= 0.0:
        way = side * gap - twist
        k = way / h if abs(way) > AT_EDGE else 0.0
        total = s + r + (a + c) * k
        new = _motor_speed(p, a + b + c, total, total - inertia * w - a * v, w, load, motor, h)
        return new, new - k, side
    damping = p[TWIST_DAMPING]
    early = explicit_share(damping, inertia * a / (inertia + a), h)
    e = h * (stiffness * (twist - side * gap + 0.25 * h * (w - v)) + early * damping * (w - v))
    slope = 0.25 * h * h * stiffness + h * (1.0 - early) * damping
    if gap > 0.0 and (e + slope * (free - alone)) * side <= 0.0:
        return free, alone, 0.0  # it is leaving the edge
    base, gain = (r + e) / (a + slope), slope / (a + slope)
    total = s - e - (c - slope) * base
    new = _motor_speed(p, b + slope + (c - slope) * gain, total, total - inertia * w, w, load, motor, h)
    return new, base + gain * new, 0.0


@njit(cache=True, error_model="numpy")
def _motor_speed(p, mass, free, pushed, w, load, motor, h):  # pragma: no cover - compiled
    """Solution of mass w' = free − h F sign(w'); pushed: of the torques alone, that must break friction at rest."""
    side = 1.0 if free > 0.0 else -1.0
    dry = h * dry_friction(p, w, load, motor, side)
    if abs(free) <= dry:
        return 0.0
    new = (free - side * dry) / mass
    if p[STATIC] != 0.0 and w * new < 0.0 and abs(pushed) <= h * dry_friction(p, 0.0, load, motor, side):
        return 0.0
    return new
