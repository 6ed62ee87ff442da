"""Motions that an arm is asked to follow: sums of sines, or moves from pose to pose with pauses."""

from __future__ import annotations

import numpy as np

from validation.another_simulator.mujoco_arm import Reference

REACH, OF_SPEED = 1.4, 0.7  # [rad] at most about the middle; share of the speed limit
SINES = 5
RISE = 1.5  # [s] in which sines grow


def drawn(style: str, lower: np.ndarray, upper: np.ndarray, speed: np.ndarray, seconds: float, rng) -> Reference:
    """A motion of one style, "sines" or "moves", within limits of shape (dof,)."""
    reach = np.minimum(0.375 * (upper - lower), REACH)
    middle = (lower + upper) / 2 + rng.uniform(-0.2, 0.2, lower.size) * reach
    make = _sines if style == "sines" else _moves
    return make(middle, reach, OF_SPEED * speed, seconds, rng)


def _sines(middle: np.ndarray, reach: np.ndarray, fastest: np.ndarray, seconds: float, rng) -> Reference:
    n = middle.size
    omega = 2.0 * np.pi * rng.uniform(0.04, 0.07) * np.array([rng.permutation(9)[:SINES] + 1 for _ in range(n)])
    size, phase = rng.normal(size=(n, SINES)) / np.sqrt(omega), rng.uniform(0.0, 2.0 * np.pi, (n, SINES))
    clock = np.linspace(0.0, seconds, 4000)
    angle = omega[..., None] * clock + phase[..., None]
    far = np.abs((size[..., None] * np.sin(angle)).sum(axis=1)).max(axis=1)
    fast = np.abs(((size * omega)[..., None] * np.cos(angle)).sum(axis=1)).max(axis=1)
    size = size * np.minimum(reach / far, fastest / fast)[:, None]

    def at(t: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        angle, share = omega * t + phase, min(1.0, t / RISE)
        grown = share * share * (3.0 - 2.0 * share)
        q, v, a = size * np.sin(angle), size * omega * np.cos(angle), -size * omega**2 * np.sin(angle)
        return middle + grown * q.sum(axis=1), grown * v.sum(axis=1), grown * a.sum(axis=1)

    return at


def _moves(middle: np.ndarray, reach: np.ndarray, fastest: np.ndarray, seconds: float, rng) -> Reference:
    poses, times = [middle], [0.0]
    while times[-1] < seconds:
        pose = middle + rng.uniform(-1.0, 1.0, middle.size) * reach
        lasts = max(float(np.max(1.875 * np.abs(pose - poses[-1]) / fastest)), 0.6)
        poses += [pose, pose]
        times += [times[-1] + lasts, times[-1] + lasts + rng.uniform(0.05, 0.4)]

    def at(t: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        k = min(int(np.searchsorted(times, t, side="right")) - 1, len(times) - 2)
        lasts, way = times[k + 1] - times[k], poses[k + 1] - poses[k]
        s = (t - times[k]) / lasts
        share, rate, change = 10 * s**3 - 15 * s**4 + 6 * s**5, 30 * s**2 - 60 * s**3 + 30 * s**4, 60 * s - 180 * s**2
        return poses[k] + way * share, way * rate / lasts, way * (change + 120 * s**3) / lasts**2

    return at
