"""A torque signal that hums: a line in its spectrum that no motion makes, told so that none takes it for mere noise."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.signal import periodogram

from lagnet.recordings.conditioning import Conditioned, Stretch

MOST_OF = 0.5  # of the power above the motion's band that one line holds
BINS = 4  # of the spectrum on both sides that belong to a line
ABOVE = 1.5  # times the bandwidth, from where motion leaves nothing in a torque
LONG = 256  # samples that a spectrum is taken of at least


def told_of_hum(conditioned: Conditioned, joints: tuple[str, ...]) -> Iterator[str]:
    """A sentence for each joint whose torque hums on most stretches."""
    stretches = [s for s in conditioned.stretches if s.time.size >= LONG]
    for j, joint in enumerate(joints):
        lines = [line for s in stretches if (line := hum(s, j, conditioned)) is not None]
        if lines and 2 * len(lines) > len(stretches):
            frequency, size = np.median(lines, axis=0)
            yield (
                f"the torque of {joint} hums at {frequency:.3g} Hz ({size:.2g} rms, in the torque's unit), which "
                "counts as noise: look at the supply, the shielding, or at what runs at that speed"
            )


def hum(stretch: Stretch, joint: int, conditioned: Conditioned) -> tuple[float, float] | None:
    """Frequency [Hz] and root mean square of the line that holds most of the torque above the motion's band."""
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
