"""At rest the residual does not vary with position: holding the arm is the business of g."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding, NotApplicable
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import Subject

SAMPLES = 512


class ResidualHoldsNoGravity(Check):
    """Variation of ε(q, 0, 0) over positions, against that of gravity torque; a constant offset is allowed."""

    name = "residual_holds_no_gravity"
    title = "the residual holds no part of the gravity torque"
    meaning = "The residual carries conservative torque: gravity, mass and energy read from the model are wrong."
    justification = "2 % of the gravity torque is what torque sensors resolve; below it no recording can tell."

    def limit(self, subject: Subject) -> float:
        return 0.02

    def find(self, subject: Subject) -> Finding:
        if not subject.offers("residual_torque"):
            raise NotApplicable("the model sets no residual apart")
        if not subject.residual_present.any():
            raise NotApplicable("the residual is zero")
        if getattr(subject.model, "effects", ()):
            raise NotApplicable("the residual is made of named effects, of which springs and gains do hold the arm")
        q, _, _ = subject.random(SAMPLES, salt=11)
        at_rest, g = self._at_rest(subject, q), subject.gravity_torque(q) + 0.0
        carried = np.sqrt(np.var(g, axis=0))
        if carried.max() <= 1e-6 * subject.torque_scale.max():
            raise NotApplicable("gravity turns no joint")
        # Joints that gravity hardly turns are measured against a fiftieth of the one that it turns most.
        share = np.sqrt(np.var(at_rest, axis=0)) / np.maximum(carried, 0.02 * carried.max())
        joint, mean = int(np.argmax(share)), at_rest.mean(axis=0)
        _, where = worst_configuration(subject, "q", lambda q: np.abs(self._at_rest(subject, q) - mean)[:, joint])
        detail = f"at rest the residual of {subject.joints[joint]} varies by this share of the gravity torque"
        return Finding(float(share[joint]), {"joint": subject.joints[joint], **where}, detail)

    @staticmethod
    def _at_rest(subject: Subject, q: np.ndarray) -> np.ndarray:
        return subject.residual(q, np.zeros_like(q), np.zeros_like(q))
