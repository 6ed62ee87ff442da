"""duty = γ (u − q − δ − T v) / E: what a recorded duty says of the controller by itself, whatever moves the joint.

γ: gains of a recording over those of the law; T: time between the readings of position and duty. Where duty follows
the command error on one line, the controller is proportional, sees the joint at the bias δ, and gives full duty at the
error E: these are measured, not fitted to motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.recordings.recording import Recording

FULL = 0.95  # |duty| from which on it may be limited
LEAST = 100  # samples below it
REACHED = 0.1  # of duty that must be reached on a line through many errors
UNSTRAIGHT = 0.02  # greatest root mean square of what is left, over that of the duty


@dataclass(frozen=True)
class DutyLine:
    """A proportional controller as its duty shows it: full_error E at gain 1 and bias δ, both in rad."""

    full_error: float
    bias: float


def duty_line(recordings: Sequence[Recording], gains: Sequence[float] | None, joint: int) -> DutyLine | None:
    """The line of one joint over all recordings, None where duty was not recorded everywhere or lies on no line.

    Args:
        recordings: with commands.
        gains: γ of each, 1 where None.
        joint: its index.
    """
    if any(r.duty is None or r.command is None for r in recordings):
        return None
    factors = gains or [1.0] * len(recordings)
    rows = [_columns(p, gamma, joint) for r, gamma in zip(recordings, factors, strict=True) for p in r.parts()]
    error, speed, gain, duty = (np.concatenate(column) for column in zip(*rows, strict=True))
    if len(duty) < LEAST or np.abs(duty).max() < REACHED:
        return None
    columns = np.column_stack([error, -gain, -speed])  # 1/E, δ/E, T/E
    found, *_ = np.linalg.lstsq(columns, duty, rcond=None)
    left = float(np.sqrt(np.mean((columns @ found - duty) ** 2)))
    if not found[0] > 0.0 or left > UNSTRAIGHT * float(np.sqrt(np.mean(duty**2))):
        return None
    return DutyLine(float(1.0 / found[0]), float(found[1] / found[0]))


def _columns(recording: Recording, gamma: float, joint: int) -> tuple[np.ndarray, ...]:
    """γ (u − q), γ v, γ and duty of the samples at which the drive is on and its duty below the limit."""
    command, duty = np.array(recording.command)[:, joint], np.array(recording.duty)[:, joint]
    on = np.abs(duty) < FULL
    if recording.enabled is not None:
        on &= np.array(recording.enabled)[:, joint] > 0.5
    q = np.array(recording.q)[:, joint]
    speed = np.gradient(q, recording.time) if len(q) > 1 else np.zeros_like(q)
    return gamma * (command - q)[on], gamma * speed[on], np.full(int(on.sum()), gamma), duty[on]
