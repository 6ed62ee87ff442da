"""Commands of a recording: steps, slow turns, and a chirp."""

from __future__ import annotations

from typing import Any

import numpy as np

STEPS, SLOW = 0.4, 0.7  # shares of a recording at which steps, and slow turns, end
HOLD = 1.6  # [s] of a step
CHIRP = (0.2, 1.7)  # [Hz] first and last frequency


def commands(rng: np.random.Generator, time: np.ndarray, robot: Any) -> np.ndarray:
    """Commands within the joints' limits, shape (n, dof) [rad]."""
    low, high = limits(robot)
    middle, reach = 0.5 * (low + high), np.minimum(1.0, 0.4 * (high - low))
    length = time[-1] + time[1] - time[0]
    steps = rng.uniform(-1.0, 1.0, (int(length / HOLD) + 1, robot.n_dof))[(time / HOLD).astype(int)]
    t, phase = time[:, None], rng.uniform(0.5, 1.0, robot.n_dof)
    slow = 0.15 * np.abs((t + phase) % 3.0 - 1.5) + 0.5 * phase - 0.5  # [rad], 0.15 rad/s
    since, lasts = t - SLOW * length, (1.0 - SLOW) * length
    turns = CHIRP[0] * since + 0.5 * (CHIRP[1] - CHIRP[0]) * since**2 / lasts
    chirp = 0.6 * np.sin(2.0 * np.pi * turns) * phase
    return middle + reach * np.where(t < STEPS * length, steps, np.where(t < SLOW * length, slow, chirp))


def limits(robot: Any) -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest position of every joint, at most ±3 rad."""
    return np.maximum(robot.position_lower, -3.0), np.minimum(robot.position_upper, 3.0)
