"""The gravity torque g agrees with that of a model that is believed."""

from __future__ import annotations

from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.quantities.reference_terms import compare, term_limit
from lagnet.plausibility.subject import Subject


class ReferenceGravity(Check):
    """nMSE of each joint, with an interval by resampling blocks of the motion."""

    name = "reference_gravity"
    title = "gravity torque g agrees with the reference"
    meaning = "The model may fit the whole torque and still split it wrongly: this is the gravity part alone."
    unit = "nMSE"
    justification = "1e-12 between two descriptions of bodies (their rounding squared); 0.05 for a learned model."

    def limit(self, subject: Subject) -> float:
        return term_limit(subject)

    def find(self, subject: Subject) -> Finding:
        return compare(subject, "gravity")
