"""w(t) of an effect: 1 from t0 to t1 in its own recording, 0 elsewhere; 1 throughout for an effect that persists."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np

from lagnet.effects.motion import Motion
from lagnet.recordings.sampling import median_step


@runtime_checkable
class Present(Protocol):
    """What acts on an interval, in one recording, or always."""

    @property
    def interval(self) -> tuple[float, float] | None: ...
    @property
    def recording(self) -> int | None: ...


def presence(motion: Motion, effect: Present) -> np.ndarray | float:
    """w along a motion, shape (n,), or a number where it does not change.

    It falls to 0 over one sample outside of the interval: a slope makes t0 and t1 differentiable.
    """
    if effect.recording is not None and effect.recording != motion.recording:
        return 0.0
    if effect.interval is None:
        return 1.0
    step = median_step(motion.time)
    since_start, since_end = ((motion.time - edge) / step for edge in effect.interval)
    return np.clip(since_start + 1.0, 0.0, 1.0) * np.clip(1.0 - since_end, 0.0, 1.0)
