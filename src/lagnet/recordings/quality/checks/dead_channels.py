"""Channels that never change, although the joint moves."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lagnet.recordings.quality.check import QualityCheck, Subject
from lagnet.recordings.quality.finding import CERTAIN, Finding


class DeadChannels(QualityCheck):
    """A torque that is one number throughout while its joint moves, or a position while its recorded speed is not 0."""

    name = "dead_channels"
    title = "a channel never changes"
    meaning = "A torque that is not measured would be told as physics that takes all of it away."

    def find(self, subject: Subject) -> Iterator[Finding]:
        recording = subject.recording
        tau = recording.tau
        still = np.zeros(recording.n_dof, dtype=bool) if tau is None else np.ptp(tau, axis=0) == 0
        if still.all() and not subject.moves.any():
            return
        for joint in np.flatnonzero(still & subject.moves):
            yield self._dead(subject, "tau", int(joint), recording.torque[0, joint], "although the joint moves")
        if recording.v is None:
            return
        turns = np.quantile(np.abs(recording.v), 0.9, axis=0) > 1e-2
        for joint in np.flatnonzero((np.ptp(recording.q, axis=0) == 0) & turns):
            yield self._dead(subject, "q", int(joint), recording.q[0, joint], "although its recorded speed is not zero")

    def _dead(self, subject: Subject, kind: str, joint: int, value: float, although: str) -> Finding:
        return self.found(
            subject,
            f"{subject.named(kind, joint)} is {value:.4g} in every sample {although}: the channel is dead",
            f'record {kind}_{joint} again, or map the column that holds it: [columns] "{kind}_{joint}" = "..."',
            CERTAIN,
            channel=f"{kind}_{joint}",
            harmful=True,
        )
