"""What the recording shows of the true arm: scaled, late, noisy, in steps of the encoder."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Sensors:
    """The measuring chain of one plant.

    Args:
        gain, offset, delay: shape (dof,), of the torque signal [–, N m, s].
        noise: rms of the torque noise as a share of the rms of each joint's torque.
        encoder_bits: resolution of a turn (a metre for prismatic joints) in bits; 0 for none.
        jitter: rms of the clock's jitter [s].
        velocity: whether speeds are recorded too.
        velocity_noise: [rad/s].
    """

    gain: np.ndarray
    offset: np.ndarray
    delay: np.ndarray
    noise: float = 0.01
    encoder_bits: int = 20
    jitter: float = 0.0
    velocity: bool = False
    velocity_noise: float = 1e-3

    @classmethod
    def ideal(cls, n_dof: int, **rest: float) -> Sensors:
        """A torque signal that is neither scaled, shifted nor late."""
        return cls(np.ones(n_dof), np.zeros(n_dof), np.zeros(n_dof), **rest)  # type: ignore[arg-type]

    def delayed(self, tau: np.ndarray, step: float) -> np.ndarray:
        """The torque signal as a buffer gives it out, between two samples by interpolation, shape (n, dof)."""
        time = np.arange(tau.shape[0]) * step
        return np.stack(
            [np.interp(time - late, time, column) for late, column in zip(self.delay, tau.T, strict=True)], 1
        )

    def record(
        self, q: np.ndarray, v: np.ndarray, tau: np.ndarray, step: float, every: int, rng: np.random.Generator
    ) -> dict[str, np.ndarray]:
        """Samples of the recording from the true run at the plant's step: time, q, tau and, where recorded, v."""
        shown = self.delayed(tau * self.gain + self.offset, step)
        picks = np.arange(0, q.shape[0], every)
        clock = picks * step
        if self.jitter:
            wander = rng.normal(0, self.jitter, clock.size)
            clock = clock + np.clip(wander, -0.3 * every * step, 0.3 * every * step)
        q_seen, tau_seen, v_seen = (_at(clock, x, step) for x in (q, shown, v))
        tau_seen = tau_seen + rng.normal(size=tau_seen.shape) * self.noise * np.sqrt(np.mean(tau_seen**2, axis=0))
        if self.encoder_bits:
            grain = 2 * np.pi / 2**self.encoder_bits
            q_seen = np.round(q_seen / grain) * grain
        out = {"time": clock, "q": q_seen, "tau": tau_seen}
        if self.velocity:
            out["v"] = v_seen + rng.normal(size=v_seen.shape) * self.velocity_noise
        return out


def _at(clock: np.ndarray, signal: np.ndarray, step: float) -> np.ndarray:
    grid = np.arange(signal.shape[0]) * step
    return np.stack([np.interp(clock, grid, column) for column in signal.T], axis=1)
