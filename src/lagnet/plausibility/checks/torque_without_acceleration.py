"""τ(q, v, 0) is c(q, v) + g(q)."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import Subject


class TorqueWithoutAcceleration(Check):
    """The terms that a model shows must be those that it uses."""

    name = "torque_without_acceleration"
    title = "torque without acceleration is Coriolis plus gravity torque"
    meaning = "The terms that the model shows are not those that make its torque, so that reading them misleads."
    justification = "Exact in mechanics; a thousand roundings are allowed."

    def limit(self, subject: Subject) -> float:
        return subject.at_least_rounding(1e-9)

    def find(self, subject: Subject) -> Finding:
        def off(q: np.ndarray, v: np.ndarray) -> np.ndarray:
            total = subject.mechanical_torque(q, v, np.zeros_like(q))
            return (total - subject.coriolis_torque(q, v) - subject.gravity_torque(q)) / subject.torque_scale

        worst, where = worst_configuration(subject, "qv", lambda q, v: np.abs(off(q, v)).max(axis=1))
        joint = int(np.argmax(np.abs(off(np.array([where["q"]]), np.array([where["v"]])))[0]))
        return Finding(worst.value, where, f"τ(q, v, 0) of {subject.joints[joint]} differs from c + g")
