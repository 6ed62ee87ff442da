"""The measuring chain: scaled, clipped, filtered, late, noisy, in steps of the encoder."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter, lfilter_zi

from validation.plants.arm.loop import TrueRun
from validation.plants.catalogue.assemble import Parts
from validation.plants.catalogue.plan import Plan

SPEED_NOISE = 1e-3  # [rad/s]


def shown_torque(plan: Plan, parts: Parts, tau: np.ndarray) -> np.ndarray:
    """The torque signal without noise at the plant's step, shape (n, dof)."""
    signal = np.clip(tau * parts.gain + parts.offset, -parts.ceiling, parts.ceiling)
    return late(filtered(signal, plan.current_filter, plan.step_rate), parts.delay, plan.step_rate)


def filtered(signal: np.ndarray, corner: float, rate: float) -> np.ndarray:
    """A first-order low-pass, at rest at the start."""
    if not corner:
        return signal
    keep = float(np.exp(-2 * np.pi * corner / rate))
    b, a = np.array([1 - keep]), np.array([1.0, -keep])
    return lfilter(b, a, signal, axis=0, zi=lfilter_zi(b, a)[:, None] * signal[:1])[0]


def late(signal: np.ndarray, delay: np.ndarray, rate: float) -> np.ndarray:
    """Each column by its own delay [s], between two samples by interpolation."""
    if not np.any(delay):
        return signal
    time = np.arange(signal.shape[0]) / rate
    return np.stack([np.interp(time - d, time, x) for d, x in zip(delay, signal.T, strict=True)], axis=1)


def record(plan: Plan, parts: Parts, run: TrueRun, rng: np.random.Generator) -> dict[str, np.ndarray]:
    """Columns of a recording file."""
    every = round(plan.step_rate / plan.rate)
    shown = shown_torque(plan, parts, run.tau)[::every]
    q = (run.q - parts.angle_offset)[::every]
    q = q + rng.normal(size=q.shape) * plan.angle_noise
    if plan.encoder_bits:
        grain = 2 * np.pi / 2**plan.encoder_bits
        q = np.round(q / grain) * grain
    columns = {
        "time": np.arange(q.shape[0]) / plan.rate,
        "q": q,
        "tau": shown + rng.normal(size=shown.shape) * noise_level(plan, shown),
    }
    if plan.velocity:
        columns["v"] = run.v[::every] + rng.normal(size=q.shape) * SPEED_NOISE
    return columns


def noise_level(plan: Plan, shown: np.ndarray) -> np.ndarray:
    """Rms of the torque noise of each joint [N m], shape (dof,)."""
    return plan.noise * np.sqrt(np.mean(shown**2, axis=0))
