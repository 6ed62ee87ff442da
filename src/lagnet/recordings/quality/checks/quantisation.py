"""Channels on so coarse a scale that it is most of their noise."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lagnet.recordings.quality.check import QualityCheck, Subject
from lagnet.recordings.quality.finding import LIKELY, Finding
from lagnet.recordings.quality.runs import quantum

VALUES = 40  # over the middle range of a moving channel: fewer are coarse


class Quantisation(QualityCheck):
    """A moving joint's position or torque that takes only a few dozen values."""

    name = "quantisation"
    title = "a channel is coarsely quantised"
    meaning = "Steps of the scale look like stick and slip, and small effects are lost under them."

    def find(self, subject: Subject) -> Iterator[Finding]:
        for kind, values in subject.signals():
            for joint in np.flatnonzero(subject.moves):
                x = values[:, joint]
                step = quantum(x)
                low, high = np.quantile(x, [0.05, 0.95])
                if not step > 0 or np.ptp(x) == 0 or high - low > VALUES * step:
                    continue
                yield self.found(
                    subject,
                    f"{subject.named(kind, int(joint))} is recorded in steps of {step:.3g},"
                    f" {max(1.0, (high - low) / step):.0f} of them over nine tenths of its samples:"
                    " small effects are lost under them",
                    "record more digits, if the source has them",
                    LIKELY,
                    channel=f"{kind}_{joint}",
                )
