"""Time alignment of two logs of one motion, of the real arm and of its simulation: lag = argmax of v_real ⋆ v_sim."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.signal import correlate

from lagnet.recordings.recording import Recording

RATE = 100.0  # [Hz] of the common clock
SAME = 0.15  # root mean square distance of the positions over their scatter, up to which two motions are one command
SHARED = 0.5  # of the shorter log that must overlap
LONGEST = 120.0  # [s] that is laid over each other


@dataclass(frozen=True, eq=False)
class SideBySide:
    """Torque of the real and of the simulated arm along the same commands.

    Args:
        real, simulated: names of the files.
        lag: what the clock of the simulated log is ahead of the real one [s].
        time: shape (n,), clock of the real log [s].
        tau_real, tau_simulated: shape (n, dof), [N m or N].
        joints: names.
    """

    real: str
    simulated: str
    lag: float
    time: np.ndarray
    tau_real: np.ndarray
    tau_simulated: np.ndarray
    joints: tuple[str, ...]


def lay_side_by_side(real: Sequence[Recording], simulated: Sequence[Recording]) -> tuple[SideBySide, ...]:
    """The real recordings for which a simulated one follows the same commands, each with the nearest of them."""
    pairs = []
    for one in real:
        found = [pair for pair in (_pair(one, other) for other in simulated) if pair is not None]
        if found:
            pairs.append(min(found, key=lambda pair: pair[0])[1])
    return tuple(pairs)


def _pair(real: Recording, simulated: Recording) -> tuple[float, SideBySide] | None:
    """Distance of the motions and the two logs on one clock; None where they follow other commands."""
    if real.n_dof != simulated.n_dof:
        return None
    (clock, q, tau), (_, other_q, other_tau) = (_resampled(r) for r in (real, simulated))
    shift = _shift(q, other_q)
    start, stop = max(0, -shift), min(len(q), len(other_q) - shift)
    if stop - start < SHARED * min(len(q), len(other_q)):
        return None
    rows, rows_other = slice(start, stop), slice(start + shift, stop + shift)
    distance = float(np.sqrt(np.mean((q[rows] - other_q[rows_other]) ** 2)))
    distance /= max(float(np.sqrt(np.mean(np.var(q[rows], axis=0)))), 1e-12)
    if distance > SAME:
        return None
    lag = float(simulated.time[0] - real.time[0] + shift / RATE)
    names = (_name(real, "real"), _name(simulated, "simulated"))
    return distance, SideBySide(*names, lag, clock[rows], tau[rows], other_tau[rows_other], real.joints)


def _resampled(recording: Recording) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Clock, positions and torque at a common rate."""
    clock = np.arange(recording.time[0], min(recording.time[-1], recording.time[0] + LONGEST), 1.0 / RATE)
    q, tau = (
        np.column_stack([np.interp(clock, recording.time, x[:, j]) for j in range(recording.n_dof)])
        for x in (recording.q, recording.torque)
    )
    return clock, q, tau


def _shift(q: np.ndarray, other: np.ndarray) -> int:
    """Lag in samples at which the cross-correlation of both velocities is largest; positive: the other comes later."""
    v, w = np.diff(q, axis=0), np.diff(other, axis=0)
    together = sum(correlate(w[:, j], v[:, j], mode="full", method="fft") for j in range(v.shape[1]))
    return int(np.argmax(together)) - (len(v) - 1)


def _name(recording: Recording, otherwise: str) -> str:
    return Path(recording.path).name if recording.path else otherwise
