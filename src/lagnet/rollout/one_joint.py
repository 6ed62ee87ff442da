"""Rollouts of one servo-driven joint while the others move as they were measured: one equation, exact stick and slip.

Each step solves (M + h D + h² k/4) v' = M v + h (τ − k h v/4 − h F sign(v')) for the speed v' and the friction together
(Moreau's time stepping): |impulse| ≤ h F and v' = 0, or impulse = h F against v'. A joint that sticks has v' = 0 to the
last bit, so that it never creeps; one that reverses is at rest between, and goes on only beyond break-away friction.
Springs are taken at mid-step (no numerical damping), and so are dampers where the step resolves them, else towards its
end (stable at any step). Sources: Karnopp 1985; Stewart & Trinkle 1996; Moreau 1988.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np
from numba import njit

from lagnet.rollout.damper import explicit_share
from lagnet.rollout.driven import between, drive_torque, load_at
from lagnet.rollout.transmission import yields
from lagnet.rollout.yielding_joint import FARTHEST, FINE, roll_yielding
from lagnet.servos.command_delay import integral_at
from lagnet.servos.friction import dry_friction, falls_with_speed
from lagnet.servos.parameters import (
    BIAS,
    DELAY,
    LOAD_GAIN,
    OFFSET,
    QUADRATIC,
    ROTOR,
    SPRING,
    VISCOUS,
)


@dataclass(frozen=True, eq=False)
class JointSeries:
    """What drives one joint, sample by sample, all of shape (n,); several recordings one after the other.

    Args:
        time: [s], increasing within a recording.
        command, integral: commanded position [rad] and its integral over time within the recording.
        q: measured position [rad].
        mass: M_ii of the nominal model without its rotor [kg m²].
        load: torque of gravity and of the other joints' motion in the nominal model, at the measured pose [N m].
        load_slope: derivative of that load by the joint's own position [N m/rad].
        ratio: voltage over nominal voltage; gain: the controller's gains over those of the law;
            enabled: whether the drive gives torque.
    """

    time: np.ndarray
    command: np.ndarray
    integral: np.ndarray
    q: np.ndarray
    mass: np.ndarray
    load: np.ndarray
    load_slope: np.ndarray
    ratio: np.ndarray
    gain: np.ndarray
    enabled: np.ndarray

    def arrays(self) -> tuple[np.ndarray, ...]:
        """The fields in their order."""
        return tuple(getattr(self, name) for name in self.__dataclass_fields__)


@dataclass(frozen=True, eq=False)
class Windows:
    """Stretches that are rolled out from their first sample.

    Args:
        first, last: shape (w,), first and last sample of each.
        floor: shape (w,), first sample of its recording, before which the first command was held.
        speed: shape (w,), speed at the first sample [rad/s].
    """

    first: np.ndarray
    last: np.ndarray
    floor: np.ndarray
    speed: np.ndarray


def roll_out(parameters: np.ndarray, series: JointSeries, windows: Windows, step: float = 0.004) -> np.ndarray:
    """Positions predicted in every window, shape (sets, n); samples outside of windows keep the measured position.

    Args:
        parameters: shape (sets, len(LAW)).
        step: longest step of integration [s].
    """
    parameters = np.atleast_2d(np.ascontiguousarray(parameters, dtype=float))
    out = np.tile(series.q, (len(parameters), 1))
    where = (windows.first, windows.last, windows.floor, windows.speed)
    for law, predicted in zip(parameters.tolist(), out, strict=True):
        _roll_law(tuple(law), series.arrays(), where, step, predicted)
    return out


@njit(cache=True, error_model="numpy", nogil=True)
def _roll_law(p, series, windows, step, out):  # pragma: no cover - compiled
    """Every window under one law; a tuple, whose numbers no write into `out` can change: they stay in registers."""
    for w in range(windows[0].size):
        where = (windows[0][w], windows[1][w], windows[2][w])
        if yields(p):
            roll_yielding(p, series, where, windows[3][w], min(step, FINE), out)
        else:
            _roll_window(p, series, where, windows[3][w], step, out)


@njit(cache=True, error_model="numpy")
def _roll_window(p, series, where, speed, step, out):  # pragma: no cover - compiled
    time, command, integral, measured, mass, load, slope, ratio, gain, enabled = series
    first, last, floor = where
    q, v, total, k = out[first], speed, 0.0, first
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
            m = p[LOAD_GAIN] * between(x, mass, n) + p[ROTOR]
            error = u - q - p[BIAS]
            driven = drive_torque(p, error, total, v, ratio[n], gain[n], enabled[n], h)
            torque, stiff, damp, brake, total = driven
            new = next_speed(p, v, m, torque + p[OFFSET], stiff + p[SPRING], damp, brake, felt, h)
            q += 0.5 * h * (v + new)
            v = new
            if not abs(q) < FARTHEST:
                q, v = FARTHEST, 0.0
        out[n + 1] = q


@njit(cache=True, error_model="numpy")
def next_speed(p, v, m, torque, stiff, damp, brake, load, h):  # pragma: no cover - compiled
    """Speed at the end of a step of h, with the dry friction that goes with it."""
    damping = damp + brake + p[VISCOUS] + p[QUADRATIC] * abs(v)
    early = explicit_share(damping, m, h)
    drive = torque + (damp - early * damping) * v - 0.25 * h * stiff * v - load
    free = m * v + h * drive
    side = 1.0 if free > 0.0 else -1.0
    dry = h * dry_friction(p, v, load, torque - p[OFFSET] - brake * v, side)
    if abs(free) <= dry:
        return 0.0
    new = (free - side * dry) / (m + h * (1.0 - early) * damping + 0.25 * h * h * stiff)
    if falls_with_speed(p) and v * new < 0.0:  # it passes rest
        motor = torque + damp * v  # there
        if abs(motor - load) <= dry_friction(p, 0.0, load, motor - p[OFFSET], side):
            return 0.0
    return new
