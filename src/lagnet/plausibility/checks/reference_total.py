"""The whole torque agrees with that of a model that is believed."""

from __future__ import annotations

from lagnet.plausibility.check import Check, Finding, NotApplicable
from lagnet.plausibility.quantities.reference_terms import compare, has_residual, term_limit
from lagnet.plausibility.subject import Subject


class ReferenceTotal(Check):
    """nMSE of each joint of the torque; a residual against a reference without one is the model's own business."""

    name = "reference_total"
    title = "the whole torque agrees with the reference"
    meaning = "The model asks for other torques than the one that is believed."
    unit = "nMSE"
    justification = "1e-12 between two descriptions of bodies (their rounding squared); 0.05 for a learned model."
    stays_because = (
        "a wrong term shows in its own check too, unless errors of two terms add up; users ask for this number first"
    )

    def limit(self, subject: Subject) -> float:
        return term_limit(subject)

    def find(self, subject: Subject) -> Finding:
        if subject.reference is not None and subject.residual_present.any() and not has_residual(subject):
            raise NotApplicable("the model has a residual that the reference does not know")
        return compare(subject, "total")
