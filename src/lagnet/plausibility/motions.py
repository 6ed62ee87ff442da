"""Smooth random motions through the box of motion, with the weights that integrate along them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.plausibility.subject import Subject

DURATION, PANELS, POINTS = 2.0, 24, 8  # [s]; Gauss-Legendre panels and points in each: 1e-12 for these motions
FREQUENCIES = np.array([0.3, 0.7])  # [Hz], not multiples of each other, so that no motion closes on itself


@dataclass(frozen=True, eq=False)
class SmoothMotion:
    """m motions at once.

    Args:
        q, v, a: shape (m, n, dof), at the points of integration.
        ends: (q, v) at the end of every panel, each of shape (m, panels + 1, dof).
        weights: shape (n,), [s].
    """

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    ends: tuple[np.ndarray, np.ndarray]
    weights: np.ndarray

    def integrals(self, power: np.ndarray) -> np.ndarray:
        """Integral of a power of shape (m, n) from the start to the end of every panel, shape (m, panels + 1)."""
        work = (power * self.weights).reshape(len(power), PANELS, POINTS).sum(axis=2)
        return np.concatenate([np.zeros((len(power), 1)), np.cumsum(work, axis=1)], axis=1)


def dimension(subject: Subject) -> int:
    """How many numbers in [-1, 1] make one motion: amplitude and phase of each frequency and joint."""
    return 2 * FREQUENCIES.size * subject.n_dof


def motions(subject: Subject, points: np.ndarray) -> SmoothMotion:
    """The motions of m points of the cube, shape (m, dimension)."""
    box, m = subject.ranges, len(points)
    half = (box.upper - box.lower) / 2
    size, phase = np.moveaxis(points.reshape(m, 2, FREQUENCIES.size, subject.n_dof), 1, 0)
    rate = 2 * np.pi * FREQUENCIES
    # No faster than the box allows: a joint with a wide range does not swing through all of it in a second.
    allowed = np.minimum(half[None], box.velocity[None] / rate[:, None]) / FREQUENCIES.size
    size, phase = size * allowed, np.pi * phase
    edges = np.linspace(0.0, DURATION, PANELS + 1)
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    width = edges[1] - edges[0]
    time = (edges[:-1, None] + width * (nodes + 1) / 2).ravel()
    centre = (box.upper + box.lower) / 2
    q, v, a = (_swing(size, phase, rate, time, order) for order in (0, 1, 2))
    at_ends = [_swing(size, phase, rate, edges, order) for order in (0, 1)]
    return SmoothMotion(centre + q, v, a, (centre + at_ends[0], at_ends[1]), np.tile(width * weights / 2, PANELS))


def _swing(size: np.ndarray, phase: np.ndarray, rate: np.ndarray, time: np.ndarray, order: int) -> np.ndarray:
    angle = rate[None, :, None, None] * time[None, None, None, :] + phase[..., None] + order * np.pi / 2
    return np.einsum("mfj,f,mfjt->mtj", size, rate**order, np.sin(angle))
