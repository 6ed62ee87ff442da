"""Narrowband (tonal) disturbance of a torque signal: a line of its power spectrum above the band of the motion.

It counts into the noise floor; the verdict warns of it, since its cause (supply, shielding, a machine) can be removed.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.signal import periodogram

from lagnet.recordings.conditioning.condition import Conditioned, Stretch

MOST_OF = 0.5  # of the power above the motion's band that one line holds
BINS = 4  # of the spectrum on both sides that belong to a line
ABOVE = 1.5  # times the bandwidth, from where motion leaves nothing in a torque
LONG = 256  # samples that a spectrum is taken of at least
LEAST = 0.01  # of the torque's standard deviation: a smaller line is nobody's trouble


def tonal_noise_words(conditioned: Conditioned, joints: tuple[str, ...]) -> Iterator[str]:
    """One warning that tells the joints whose torque has a tonal disturbance on most stretches, none without any."""
    stretches = [s for s in conditioned.stretches if s.time.size >= LONG]
    told = []
    for j, joint in enumerate(joints):
        lines = [line for s in stretches if (line := spectral_line(s, j, conditioned)) is not None]
        if not lines or 2 * len(lines) <= len(stretches):
            continue
        frequency, size = np.median(lines, axis=0)
        if size >= LEAST * np.median([np.std(s.tau[:, j]) for s in stretches]):
            told.append(f"{joint} at {frequency:.3g} Hz ({size:.2g} rms)")
    if told:
        yield (
            f"the torque hums, in its own unit: {', '.join(told)}. That counts as noise: look at the supply, the "
            "shielding, or at what runs at that speed"
        )


def spectral_line(stretch: Stretch, joint: int, conditioned: Conditioned) -> tuple[float, float] | None:
    """Frequency [Hz] and root mean square [N m] of the line that holds most power above the motion's band, if any."""
    frequency, density = periodogram(stretch.tau[:, joint], conditioned.rate, window="hann", detrend="linear")
    high = np.flatnonzero(frequency > ABOVE * conditioned.bandwidth)
    if high.size < 8 * BINS:
        return None
    power = density[high]
    peak = int(np.argmax(power))
    line = float(power[max(0, peak - BINS) : peak + BINS + 1].sum())
    if not line > MOST_OF * float(power.sum()):
        return None
    return float(frequency[high[peak]]), float(np.sqrt(line * frequency[1]))
