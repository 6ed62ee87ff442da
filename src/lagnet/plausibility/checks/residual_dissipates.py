"""The part ε of the torque takes energy out of the arm, on every joint and on average."""

from __future__ import annotations

import numpy as np

from lagnet.percent import percent
from lagnet.plausibility.check import Check, Finding, NotApplicable
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import Subject

SAMPLES = 1024


class ResidualDissipates(Check):
    """ε is torque that the motors must add, so that friction has ε·v ≥ 0: power that the arm loses.

    Where ε is counted the other way, as the torque that the residual exerts on the arm, the same statement is ε·v ≤ 0.

    What ε has in common at v and −v (gravity, offsets, inertia) does no work over a cycle and is left out: only the
    part that turns with the direction of motion is judged. Its worst place is searched and told, but a joint fails by
    its average: a fitted residual may err locally where it has seen no data.
    """

    name = "residual_dissipates"
    title = "the residual torque takes energy out"
    meaning = (
        "The residual drives the arm on average, as no passive mechanism does: ε is torque that the motors must add, "
        "so friction has ε·v ≥ 0, and the torque −ε that it exerts on the arm has power ≤ 0."
    )
    justification = "Dissipation is not negative; 1e-9 is rounding. 1 is pure friction, −1 pure drive."
    at_least = True

    def limit(self, subject: Subject) -> float:
        return -1e-9

    def find(self, subject: Subject) -> Finding:
        if not subject.offers("residual_torque"):
            raise NotApplicable("the model sets no residual apart")
        if not (present := subject.residual_present).any():
            raise NotApplicable("the residual is zero")
        q, v, a = subject.random(SAMPLES, salt=10)
        power = _power(subject, q, v, a)
        total, size = power.sum(axis=0), np.abs(power).sum(axis=0)
        share = np.where(present & (size > 0), total / np.where(size > 0, size, 1.0), 1.0)
        joint = int(np.argmin(share))
        worst, where = worst_configuration(subject, "qva", lambda q, v, a: -(_power(subject, q, v, a)[:, joint]))
        drives = float(np.mean(power[:, joint] < 0))
        detail = (
            f"residual of {subject.joints[joint]} drives in {percent(drives)} of the samples, "
            f"with up to {max(worst.value, 0.0):.3g} W; net share of the power ε·v that it takes out"
        )
        return Finding(float(share[joint]), {"joint": subject.joints[joint], **where}, detail)


def _power(subject: Subject, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Power [W] that the direction-dependent part of ε takes out, shape (n, dof)."""
    return 0.5 * (subject.residual(q, v, a) - subject.residual(q, -v, a)) * v
