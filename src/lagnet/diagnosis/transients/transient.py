"""An effect that acts on an interval of one recording only."""

from __future__ import annotations

from dataclasses import dataclass

from lagnet.diagnosis.transients.fitting import EventFit
from lagnet.models.corrected.named_effects import NamedEffect


@dataclass(frozen=True, eq=False)
class Transient:
    """One effect that acts on an interval of one recording.

    Args:
        effect: with its interval and recording, refitted together with the persistent effects.
        intervals: 95 % interval of each parameter, t0 and t1 among them.
        fit: how it was chosen.
        share: of the mismatch of all fitted recordings that it explains, 0 to 1.
    """

    effect: NamedEffect
    intervals: dict[str, tuple[float, float]]
    fit: EventFit
    share: float
