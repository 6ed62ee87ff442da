"""v and a of measured motion, with what smoothing takes from them given back as far as a rollout predicts it.

A cubic over `SMOOTHING` seconds rounds a start off: its acceleration is too small and lasts too long, and so is the
load that this joint lays on its neighbours. A rollout p of the nominal servos knows its own rates: smoothed like the
measured motion it shows what smoothing S takes away,

    v̂ = S'q + β (p' − S'p),   v̂' = S''q + β (p'' − S''p),

with β, between 0 and 1, the share of it that the measured motion confirms: the regression of q − Sq on p − Sp.
"""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.motion.smoothing import motion_rates, smoothed


def sharpened_rates(time: np.ndarray, q: np.ndarray, predicted: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Speed and acceleration, each of shape (n, dof) [rad/s, rad/s²].

    Args:
        time: shape (n,) [s].
        q: shape (n, dof), measured positions [rad].
        predicted: shape (n, dof), a rollout of the same commands.
    """
    speed, acceleration = motion_rates(time, q)
    smooth_speed, smooth_acceleration = motion_rates(time, predicted)
    share = confirmed(q - smoothed(time, q), predicted - smoothed(time, predicted))
    exact_speed, exact_acceleration = _differences(time, predicted)
    return (
        speed + share * (exact_speed - smooth_speed),
        acceleration + share * (exact_acceleration - smooth_acceleration),
    )


def confirmed(measured: np.ndarray, predicted: np.ndarray) -> np.ndarray:
    """argmin |measured − β predicted|² of every joint, within 0 and 1, shape (dof,); arrays of shape (n, dof)."""
    power = np.sum(predicted**2, axis=0)
    return np.clip(np.sum(measured * predicted, axis=0) / np.maximum(power, 1e-300), 0.0, 1.0)


def _differences(time: np.ndarray, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Central differences; the second one is the mean of p'' over two steps that a line between samples asks for."""
    steps = np.diff(time)[:, None]
    slopes = np.diff(p, axis=0) / steps
    second = np.zeros_like(p)
    second[1:-1] = 2.0 * np.diff(slopes, axis=0) / (steps[1:] + steps[:-1])
    return np.asarray(np.gradient(p, time, axis=0)), second
