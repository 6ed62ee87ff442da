"""The recorded torques lie within the effort limits of the description."""

from __future__ import annotations

from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.quantities.recorded import largest_share, limits_of
from lagnet.plausibility.subject import Subject


class RecordingWithinEfforts(Check):
    """Largest recorded torque over the joint's limit."""

    name = "recording_within_efforts"
    title = "recorded torques lie within the effort limits"
    meaning = "The real robot pushes harder than its description allows: a simulation that obeys it cannot follow."
    justification = "One, and 5 % for the noise of recorded torques."

    def limit(self, subject: Subject) -> float:
        return 1.05

    def find(self, subject: Subject) -> Finding:
        return largest_share(subject, "tau", limits_of(subject, "effort_limit"), "torque")
