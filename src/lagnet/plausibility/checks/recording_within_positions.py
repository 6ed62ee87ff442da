"""The recorded positions lie within the joint limits of the description."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.quantities.recorded import limits_of, place
from lagnet.plausibility.subject import Subject


class RecordingWithinPositions(Check):
    """How far a position lies beyond its limit, as a share of the joint's range."""

    name = "recording_within_positions"
    title = "recorded positions lie within the joint limits"
    meaning = "The recording is in degrees or counts its angle otherwise, or the limits are another robot's."
    justification = "A hundredth of the range: hard stops are soft, and zeros of encoders differ."

    def limit(self, subject: Subject) -> float:
        return 0.01

    def find(self, subject: Subject) -> Finding:
        lower, upper = limits_of(subject, "position_lower"), limits_of(subject, "position_upper")
        width = np.where(np.isfinite(upper - lower) & (upper > lower), upper - lower, 2 * np.pi)
        found = []
        for recording in subject.recordings:
            beyond = np.maximum(recording.q - upper, lower - recording.q) / width
            row, joint = (int(i) for i in np.unravel_index(np.argmax(beyond), beyond.shape))
            detail = (
                f"{subject.joints[joint]} is at {recording.q[row, joint]:.4g} {subject.unit('q', joint)}, allowed is "
            )
            detail += f"{lower[joint]:.4g} … {upper[joint]:.4g}; beyond by this share of the range"
            spot = place(subject, recording, row, joint)
            found.append(Finding(max(float(beyond[row, joint]), 0.0), spot, detail))
        return max(found, key=lambda f: f.value)
