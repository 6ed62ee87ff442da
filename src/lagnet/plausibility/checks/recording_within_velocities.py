"""The recorded speeds lie within the velocity limits of the description."""

from __future__ import annotations

from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.quantities.recorded import largest_share, limits_of
from lagnet.plausibility.subject import Subject


class RecordingWithinVelocities(Check):
    """Largest recorded speed over the joint's limit."""

    name = "recording_within_velocities"
    title = "recorded speeds lie within the velocity limits"
    meaning = "The real robot moves faster than its description allows: a simulation that obeys it cannot follow."
    justification = "One, and 5 % for the noise of recorded speeds."

    def limit(self, subject: Subject) -> float:
        return 1.05

    def find(self, subject: Subject) -> Finding:
        return largest_share(subject, "v", limits_of(subject, "velocity_limit"), "speed")
