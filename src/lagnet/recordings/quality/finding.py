"""One thing that is wrong with the data of a recording: what, where, how sure, and what mends it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

CERTAIN, LIKELY, POSSIBLE = "certain", "likely", "possible"
NO_ROWS = np.zeros(0, dtype=np.int64)


@dataclass(frozen=True, eq=False)
class Finding:
    """One fault of the data.

    Args:
        check: name of the check that found it.
        recording: path of the recording, "" for all of them.
        channel: the column, such as q_2 or tau_0; "" where it is not one column's.
        interval_s: first and last time [s] at which it shows, None for the whole recording.
        certainty: "certain", "likely" or "possible".
        detail: one sentence: what was seen.
        mend: the line of a mapping file, or the step, that mends it.
        rows: samples that are to be set aside, increasing.
        time: shape (n,), times [s] at which all samples were measured; None where the stamps stand.
        harmful: whether a diagnosis of these recordings would tell the fault as physics.
    """

    check: str
    recording: str
    channel: str
    interval_s: tuple[float, float] | None
    certainty: str
    detail: str
    mend: str
    rows: np.ndarray = field(default_factory=lambda: NO_ROWS)
    harmful: bool = False
    time: np.ndarray | None = None

    @property
    def refused(self) -> bool:
        """Whether nothing can be concluded from the recording as it is."""
        return self.harmful and self.certainty == CERTAIN

    def sentence(self) -> str:
        """What was seen and what mends it, for a terminal."""
        where = f"{self.recording}: " if self.recording else ""
        sure = "" if self.certainty == CERTAIN else f" ({self.certainty})"
        return f"{where}{self.detail}{sure}; {self.mend}"

    def to_dict(self) -> dict[str, Any]:
        """The keys of `data_quality` in a verdict."""
        return {
            "check": self.check,
            "recording": self.recording,
            "channel": self.channel,
            "interval_s": None if self.interval_s is None else list(self.interval_s),
            "certainty": self.certainty,
            "detail": self.detail,
            "mend": self.mend,
        }
