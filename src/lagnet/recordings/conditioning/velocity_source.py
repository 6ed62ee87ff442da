"""Recorded speed or d/dt of positions: whichever is less noisy, frequency by frequency, and the reason in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.percent import percent
from lagnet.recordings.conditioning.smoothing import SHORTEST, derivative, even_clock, low_pass, resample
from lagnet.recordings.conditioning.stretches import stretches_of
from lagnet.recordings.recording import Recording

DISAGREEMENT = 0.05  # recorded velocity further than this from that of the positions is not used
MOVING = 0.01  # of the power of the fastest joint: slower joints are not compared
NOT_RECORDED = "no recording has speeds of all joints"
NOISIER = "the recorded speeds are noisier than differentiated positions wherever the arm moves"


@dataclass(frozen=True)
class VelocitySource:
    """Where velocity comes from.

    Args:
        crossover: frequency above which recorded speed is used [Hz]; None: it is not used.
        reason: why.
    """

    crossover: float | None
    reason: str

    @property
    def name(self) -> str:
        """ "recorded" or "differentiated"."""
        return "differentiated" if self.crossover is None else "recorded"


def choose_velocity(
    recordings: Sequence[Recording], noise: Mapping[str, np.ndarray], rate: float, motion_band: float
) -> VelocitySource:
    """Recorded speed above the frequency where it is less noisy than differentiated position, if the two agree.

    Args:
        noise: white noise of "q" and, where all recordings have speeds, "v", shape (dof,) each.
        rate: of the even clock [Hz].
        motion_band: bandwidth of the motion [Hz].
    """
    if "v" not in noise:
        return VelocitySource(None, NOT_RECORDED)
    for recording in recordings:
        off = _difference(recording, rate, motion_band)
        if off is None or np.any(off > DISAGREEMENT):
            return VelocitySource(None, _disagreement(recording, off))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = noise["v"] / noise["q"] / (2.0 * np.pi)
    finite = ratio[np.isfinite(ratio) & (ratio > 0)]
    crossover = float(np.median(finite)) if finite.size else np.inf
    if crossover >= 0.8 * motion_band:
        return VelocitySource(None, NOISIER)
    used_from = max(crossover, 2.0 * rate / max(len(r) for r in recordings) + 0.1)
    return VelocitySource(used_from, f"recorded speeds are less noisy above {used_from:.2g} Hz")


def _disagreement(recording: Recording, off: np.ndarray | None) -> str:
    """What the recorded speeds of one recording have against them."""
    where = f" in {recording.path}" if recording.path else ""
    if off is None:
        return f"no stretch{where} is long enough to compare recorded speeds with positions"
    worst = int(np.argmax(off))
    return (
        f"the recorded speed of {recording.joints[worst]}{where} is {percent(off[worst])} off the rate at which the"
        f" position changes (at most {percent(DISAGREEMENT)})"
    )


def _difference(recording: Recording, rate: float, motion_band: float) -> np.ndarray | None:
    """√(Σ(v − q̇)² / Σ q̇²) of each joint, as far as the motion goes, shape (dof,); 0 where a joint hardly moves."""
    off, power = np.zeros(recording.n_dof), np.zeros(recording.n_dof)
    for rows in stretches_of(recording):
        used = recording.used(rows)
        if len(used) < 4 * SHORTEST or used.v is None:
            continue
        clock = even_clock(used.time, rate)
        v = derivative(clock, low_pass(resample(used.time, used.q, clock), rate, motion_band))
        recorded = low_pass(resample(used.time, used.v, clock), rate, motion_band)
        inside = slice(SHORTEST, -SHORTEST)
        off += np.sum(low_pass(recorded - v, rate, 0.25 * motion_band)[inside] ** 2, axis=0)
        power += np.sum(v[inside] ** 2, axis=0)
    if not power.any():
        return None
    moving = power > MOVING * power.max()
    return np.where(moving, np.sqrt(off / np.maximum(power, 1e-300)), 0.0)
