"""What acts on a driven joint within a step: the torque of its drive, and the load at its position."""

from __future__ import annotations

from numba import njit

from lagnet.servos.controller import controller_torque, outside_dead_band
from lagnet.servos.parameters import BACK_EMF, DEAD_BAND, KI, LOAD_GAIN, SPRING, SPRING_REST, VOLTAGE_SHARE


@njit(cache=True, error_model="numpy")
def drive_torque(p, error, total, v, ratio, gain, enabled, h):  # pragma: no cover - compiled
    """Torque of a drive, its slopes −∂τ/∂q and −∂τ/∂v, the brake of its motor [N m s/rad], and the integral after h.

    A drive that is off gives no torque and forgets its integral.
    """
    if enabled <= 0.5:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    total += h * p[KI] * outside_dead_band(error, p[DEAD_BAND])
    supplied = 1.0 + p[VOLTAGE_SHARE] * (ratio - 1.0)
    torque, stiff, damp = controller_torque(p, error, total, v, supplied, gain)
    return torque, stiff, damp, p[BACK_EMF], total


@njit(cache=True, error_model="numpy")
def between(x, values, n):  # pragma: no cover - compiled
    """A signal at a share x of the way from sample n to the next."""
    return values[n] + x * (values[n + 1] - values[n])


@njit(cache=True, error_model="numpy")
def load_at(p, q, measured, load, slope):  # pragma: no cover - compiled
    """Load at a position [N m]: that at the measured one, its slope times the way between, and the spring."""
    felt = load + slope * (q - measured)
    return p[LOAD_GAIN] * felt + p[SPRING] * (q - p[SPRING_REST])
