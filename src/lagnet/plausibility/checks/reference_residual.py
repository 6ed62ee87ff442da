"""The residual torque ε agrees with that of a model that is believed."""

from __future__ import annotations

from lagnet.plausibility.check import Check, Finding, NotApplicable
from lagnet.plausibility.quantities.reference_terms import compare, has_residual, term_limit
from lagnet.plausibility.subject import Subject


class ReferenceResidual(Check):
    """nMSE of each joint, with an interval by resampling blocks of the motion."""

    name = "reference_residual"
    title = "residual torque ε agrees with the reference"
    meaning = "The reference has other friction, or none: what the model adds beyond mechanics is not what is believed."
    unit = "nMSE"
    justification = "1e-12 between two descriptions of bodies (their rounding squared); 0.05 for a learned model."

    def limit(self, subject: Subject) -> float:
        return term_limit(subject)

    def find(self, subject: Subject) -> Finding:
        if subject.reference is not None and not has_residual(subject):
            raise NotApplicable("the reference sets no residual apart")
        return compare(subject, "residual")
