"""A rollout of one joint whose motor and link are apart: two inertias, joined by a spring or by a play."""

from __future__ import annotations

from math import ceil

from numba import njit

from lagnet.rollout.driven import between, drive_torque, load_at
from lagnet.rollout.transmission import joined_speeds, motor_row, twist_at_rest
from lagnet.servos.command_delay import integral_at
from lagnet.servos.parameters import (
    BIAS,
    DELAY,
    ENCODER_SIDE,
    GAP,
    LOAD_GAIN,
    SPRING,
    SPRING_REST,
)

FINE = 0.002  # [s] longest step where motor and link are apart: contacts are short and springs quick
FARTHEST = 1e6  # [rad] a rollout that has left this range has diverged and stays there


@njit(cache=True, error_model="numpy")
def roll_yielding(p, series, where, speed, step, out):  # pragma: no cover - compiled
    """As `_roll_window` of a joint whose motor (angle, w) and link (q, v) are apart; it starts as at rest."""
    time, command, integral, measured, mass, load, slope, ratio, gain, enabled = series
    first, last, floor = where
    at_link = p[ENCODER_SIDE] > 0.5
    twist = twist_at_rest(p, p[LOAD_GAIN] * load[first] + p[SPRING] * (out[first] - p[SPRING_REST]))
    q, v, w, total, k = out[first], speed, speed, 0.0, first
    angle = q
    if at_link:
        angle += twist
    else:
        q -= twist
    for n in range(first, last):
        span = time[n + 1] - time[n]
        pieces = max(1, ceil(span / step - 1e-9))
        h = span / pieces
        before, k = integral_at(time[n] - p[DELAY], floor, last, k, time, command, integral)
        for i in range(pieces):
            x = (i + 0.5) / pieces
            after, k = integral_at(time[n] + (i + 1) * h - p[DELAY], floor, last, k, time, command, integral)
            u = (after - before) / h
            before = after
            felt = load_at(p, q, between(x, measured, n), between(x, load, n), between(x, slope, n))
            m = p[LOAD_GAIN] * between(x, mass, n)
            seen, seen_speed = (q, v) if at_link else (angle, w)
            error = u - seen - p[BIAS]
            driven = drive_torque(p, error, total, seen_speed, ratio[n], gain[n], enabled[n], h)
            torque, stiff, damp, brake, total = driven
            row = motor_row(p, w, v, torque, stiff, damp, brake, m, h)
            pull = m * v - h * (felt + 0.25 * h * p[SPRING] * v)
            a = m + 0.25 * h * h * p[SPRING]
            motor = torque - brake * w
            w_new, v_new, side = joined_speeds(p, row, a, pull, angle - q, w, v, felt, motor, h)
            q += 0.5 * h * (v + v_new)
            angle = q + side * p[GAP] if side != 0.0 else angle + 0.5 * h * (w + w_new)
            w, v = w_new, v_new
            if not (abs(q) < FARTHEST and abs(angle) < FARTHEST):
                q, angle, v, w = FARTHEST, FARTHEST, 0.0, 0.0
        out[n + 1] = q if at_link else angle
