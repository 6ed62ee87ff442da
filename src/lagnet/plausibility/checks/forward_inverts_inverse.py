"""Forward dynamics gives back the acceleration that inverse dynamics was asked for."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding, NotApplicable
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import Subject


class ForwardInvertsInverse(Check):
    """Accelerations are measured against the largest of the box of motion."""

    name = "forward_inverts_inverse"
    title = "forward and inverse dynamics are inverses"
    meaning = "What is commanded from the one will not be what the simulation by the other does."
    justification = "Exact in mechanics; 1e-6 leaves room for mass matrices of condition 1e8."

    def limit(self, subject: Subject) -> float:
        return max(1e-6, 1e6 * subject.rounding)

    def find(self, subject: Subject) -> Finding:
        if not subject.offers("forward_dynamics"):
            raise NotApplicable("the model has no forward_dynamics")

        def missed(q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
            back = subject.call("forward_dynamics", q, v, subject.torque(q, v, a))
            return np.abs((back - a) / subject.ranges.acceleration).max(axis=1)

        worst, where = worst_configuration(subject, "qva", missed)
        return Finding(worst.value, where, "forward_dynamics(q, v, inverse_dynamics(q, v, a)) differs from a")
