"""Motion of a few harmonics at every joint, as drawn for arms that the studies of rough models make up."""

from __future__ import annotations

import numpy as np

RATE, SECONDS, HARMONICS = 100.0, 30.0, 5
SLOWEST = 0.1  # [Hz]


def harmonics(rng: np.random.Generator, n_dof: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Time (n,) and position, speed and acceleration of every joint, shape (n, dof) each, SI units."""
    time = np.arange(round(SECONDS * RATE)) / RATE
    omega = 2.0 * np.pi * SLOWEST * np.arange(1, HARMONICS + 1)[:, None]
    size = rng.normal(0.0, 0.35, (HARMONICS, n_dof)) / np.sqrt(np.arange(1, HARMONICS + 1))[:, None]
    angle = omega * time[:, None, None] + rng.uniform(0.0, 2.0 * np.pi, (HARMONICS, n_dof))
    q = rng.uniform(-0.8, 0.8, n_dof) + (size * np.sin(angle)).sum(axis=1)
    v, a = (size * omega * np.cos(angle)).sum(axis=1), -(size * omega**2 * np.sin(angle)).sum(axis=1)
    return time, q, v, a
