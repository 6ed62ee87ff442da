"""Rollouts of a whole servo-driven arm by its commands alone, all joints coupled, with exact stick and slip.

Each step of h solves M v' + h D v' + h² K/4 v' = M v + h (τ − b − K h v/4) − h F sign(v') for all speeds and dry
frictions together (`settling`). A joint whose net torque stays below its friction gets v' = 0 to the last bit; one that
reverses is at rest between, and goes on only beyond its break-away friction. A joint whose transmission yields has a
motor, solved with its link.
Sources: Moreau 1988; Stewart & Trinkle 1996.
"""

from __future__ import annotations

from math import ceil

import numpy as np
from numba import njit

from lagnet.rigid_body.kinematic_tree import KinematicTree
from lagnet.rollout.damper import explicit_share
from lagnet.rollout.driven import drive_torque
from lagnet.rollout.rigid_bodies import dynamics, workspace
from lagnet.rollout.settling import settle, settling_space
from lagnet.rollout.surface import HARDNESS, height_above, sliding_friction
from lagnet.rollout.transmission import motor_row, twist_at_rest, yields
from lagnet.servos.command_delay import command_integral
from lagnet.servos.parameters import (
    BIAS,
    DELAY,
    ENCODER_SIDE,
    GAP,
    LOAD_GAIN,
    OFFSET,
    QUADRATIC,
    ROTOR,
    SPRING,
    SPRING_REST,
    VISCOUS,
)

FINE = 0.001  # [s] longest step where a motor is apart from its link
FARTHEST = 1e6  # [rad] beyond which a rollout has diverged


def roll_out_arm(
    tree: KinematicTree,
    parameters: np.ndarray,
    time: np.ndarray,
    command: np.ndarray,
    q0: np.ndarray,
    *,
    v0: np.ndarray | None = None,
    ratio: np.ndarray | None = None,
    gain: np.ndarray | None = None,
    enabled: np.ndarray | None = None,
    surface: np.ndarray | None = None,
    step: float = 0.002,
) -> np.ndarray:
    """Positions at every sample of a command, from the first measured position on, shape (n, dof) [rad or m].

    Args:
        tree: the rigid bodies; its armature is replaced by the `rotor` of each joint.
        parameters: shape (dof, len(LAW)).
        time: shape (n,) [s]; command: shape (n, dof), held until the next sample.
        q0: shape (dof,), start; v0: shape (dof,), its speed, at rest where None.
        ratio: shape (n, dof), voltage over nominal; gain: shape (n, dof), the controller's gains over
            those of the law; enabled: shape (n, dof), 1 where the drive gives torque.
        surface: shape (len(SURFACE),), what a point of the arm may rest on; None: nothing. A joint whose
            transmission yields does not feel it.
        step: longest step of integration [s].
    """
    n, dof = command.shape
    ones, zeros = np.ones((n, dof)), np.zeros(dof)
    signals = (
        np.ascontiguousarray(time, dtype=float),
        np.ascontiguousarray(command, dtype=float),
        command_integral(time, np.ascontiguousarray(command, dtype=float)),
        ones if ratio is None else np.ascontiguousarray(ratio, dtype=float),
        ones if gain is None else np.ascontiguousarray(gain, dtype=float),
        ones if enabled is None else np.ascontiguousarray(enabled, dtype=float),
    )
    out = np.empty((n, dof))
    start = (np.array(q0, dtype=float), np.array(zeros if v0 is None else v0, dtype=float))
    arrays = tree.arrays()
    bare = (*arrays[:6], np.zeros(dof), arrays[7])
    nothing = surface is None or not np.any(tree.gravity)  # without weight there is no up
    touched = np.zeros(0) if nothing else np.ascontiguousarray(surface, dtype=float)
    laws = np.ascontiguousarray(parameters, dtype=float)
    _roll_arm(bare, laws, signals, start, touched, step, workspace(dof), settling_space(dof), out)
    return out


@njit(cache=True, error_model="numpy", nogil=True)
def _roll_arm(tree, parameters, signals, start, surface, step, work, space, out):  # pragma: no cover - compiled
    time, command, integral, ratio, gain, enabled = signals
    q, v = start
    dof, last = q.size, time.size - 1
    mass, bias, a = np.empty((dof, dof)), np.empty(dof), np.empty((dof, dof))
    free, load, total, before = np.empty(dof), np.empty(dof), np.zeros(dof), np.empty(dof)
    motor, push = np.empty(dof), np.empty(dof)
    slopes, height, hardness, rubbing = np.zeros((3, dof)), 0.0, 0.0, 0.0
    cursor = np.zeros(dof, dtype=np.int64)
    out[0] = q
    apart = np.zeros(dof, dtype=np.bool_)
    angle, w, rows, sides, twist = q.copy(), v.copy(), np.zeros((dof, 4)), np.zeros(dof), np.empty(dof)  # of motors
    for j in range(dof):
        apart[j] = yields(parameters[j])
    if apart.any():
        step = min(step, FINE)
        _part(tree, parameters, apart, q, angle, mass, bias, work)
    for n in range(last):
        span = time[n + 1] - time[n]
        pieces = max(1, ceil(span / step - 1e-9))
        h = span / pieces
        for j in range(dof):
            delay = parameters[j, DELAY]
            before[j], cursor[j] = _integral(time[n] - delay, last, cursor[j], time, command, integral, j)
        for i in range(pieces):
            dynamics(tree, q, v, mass, bias, work)
            if surface.size:
                height, hardness = height_above(tree, surface, work, slopes), surface[HARDNESS]
                rubbing = sliding_friction(surface, slopes, height, v)
                for j in range(dof):
                    height += 0.5 * h * slopes[0, j] * v[j]
            for j in range(dof):
                p = parameters[j]
                late = time[n] + (i + 1) * h - p[DELAY]
                after, cursor[j] = _integral(late, last, cursor[j], time, command, integral, j)
                u = (after - before[j]) / h
                before[j] = after
                load[j] = p[LOAD_GAIN] * bias[j] + p[SPRING] * (q[j] - p[SPRING_REST])
                viscous = p[VISCOUS] + p[QUADRATIC] * abs(v[j])
                at_motor = apart[j] and p[ENCODER_SIDE] <= 0.5
                seen, seen_speed = (angle[j], w[j]) if at_motor else (q[j], v[j])
                error = u - seen - p[BIAS]
                torque, stiff, damp, brake, total[j] = drive_torque(
                    p, error, total[j], seen_speed, ratio[n, j], gain[n, j], enabled[n, j], h
                )
                if apart[j]:
                    rows[j] = motor_row(p, w[j], v[j], torque, stiff, damp, brake, p[LOAD_GAIN] * mass[j, j], h)
                    motor[j] = torque - brake * w[j]
                    free[j] = -h * (load[j] + 0.25 * h * p[SPRING] * v[j])
                    for m in range(dof):
                        a[j, m] = p[LOAD_GAIN] * mass[j, m]
                        free[j] += a[j, m] * v[m]
                    a[j, j] += 0.25 * h * h * p[SPRING]
                    continue
                stiff += p[SPRING]
                motor[j] = torque - brake * v[j]
                push[j] = torque + damp * v[j] + p[OFFSET] - load[j]  # at rest
                damping = viscous + brake + damp
                own = p[LOAD_GAIN] * mass[j, j] + p[ROTOR]
                early = explicit_share(damping, own, h)
                drive = torque + (damp - early * damping) * v[j] + p[OFFSET] - 0.25 * h * stiff * v[j] - load[j]
                free[j] = p[ROTOR] * v[j] + h * drive
                for m in range(dof):
                    a[j, m] = p[LOAD_GAIN] * mass[j, m]
                    free[j] += a[j, m] * v[m]
                a[j, j] += p[ROTOR] + h * (1.0 - early) * damping + 0.25 * h * h * stiff
            if rubbing > 0.0:
                for j in range(dof):
                    for m in range(dof):
                        a[j, m] += h * rubbing * (slopes[1, j] * slopes[1, m] + slopes[2, j] * slopes[2, m])
            for j in range(dof):  # q moves half a step by the old speed, half by the new
                q[j] += 0.5 * h * v[j]
                angle[j] += 0.5 * h * w[j]
                twist[j] = angle[j] - q[j] - 0.5 * h * (w[j] - v[j])  # before the step
            motors, contact = (apart, rows, twist, w, sides), (slopes[0], height, hardness)
            settle(parameters, a, free, load, motor, push, h, v, motors, contact, space)
            for j in range(dof):
                q[j] += 0.5 * h * v[j]
                angle[j] += 0.5 * h * w[j]
                if not abs(q[j]) < FARTHEST:
                    q[j], v[j], angle[j], w[j] = FARTHEST, 0.0, FARTHEST, 0.0
                if sides[j] != 0.0:
                    angle[j] = q[j] + sides[j] * parameters[j, GAP]
        for j in range(dof):
            out[n + 1, j] = angle[j] if apart[j] and parameters[j, ENCODER_SIDE] <= 0.5 else q[j]


@njit(cache=True, error_model="numpy")
def _part(tree, parameters, apart, q, angle, mass, bias, work):  # pragma: no cover - compiled
    """Motor angles and link positions at rest under gravity, of which encoders show one: q; written in place."""
    dynamics(tree, q, np.zeros(q.size), mass, bias, work)
    for j in range(q.size):
        p = parameters[j]
        if apart[j]:
            twist = twist_at_rest(p, p[LOAD_GAIN] * bias[j] + p[SPRING] * (q[j] - p[SPRING_REST]))
            if p[ENCODER_SIDE] > 0.5:
                angle[j] += twist
            else:
                q[j] -= twist


@njit(cache=True, error_model="numpy")
def _integral(t, last, k, time, command, integral, j):  # pragma: no cover - compiled
    """U_j(t) and the sample before t; the first command was held before the first sample."""
    while k > 0 and time[k] > t:
        k -= 1
    while k < last and time[k + 1] <= t:
        k += 1
    return integral[k, j] + command[k, j] * (t - time[k]), k
