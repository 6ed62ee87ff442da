"""c(q, v) is what the Christoffel symbols of H(q) give."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.quantities import derivatives
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import Subject


class CoriolisFromMassMatrix(Check):
    """Differentiates H and compares with the model's own centrifugal and Coriolis torque."""

    name = "coriolis_from_mass_matrix"
    title = "the Coriolis torque follows from the mass matrix"
    meaning = "Inertia that varies with position pushes back in one way only; another way is another arm, or none."
    justification = "Exact in mechanics; 1e-7 of the joint's torque is the error of sixth-order differences."

    def limit(self, subject: Subject) -> float:
        return derivatives.limit(subject)

    def find(self, subject: Subject) -> Finding:
        def missed(q: np.ndarray, v: np.ndarray) -> np.ndarray:
            return (self._missed(subject, q, v) / subject.torque_scale).max(axis=1)

        worst, where = worst_configuration(subject, "qv", missed)
        q, v = np.array([where["q"]]), np.array([where["v"]])
        joint = int(np.argmax(self._missed(subject, q, v)[0] / subject.torque_scale))
        gradient, _ = derivatives.position_gradient(subject, subject.mass_matrix, q)
        own, christoffel = (
            subject.coriolis_torque(q, v)[0, joint],
            derivatives.christoffel_torque(gradient, v)[0, joint],
        )
        detail = (
            f"c of {subject.joints[joint]} is {own:.6g}, from H it is {christoffel:.6g} {subject.unit('tau', joint)}"
        )
        return Finding(worst.value, where, detail)

    @staticmethod
    def _missed(subject: Subject, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        gradient, error = derivatives.position_gradient(subject, subject.mass_matrix, q)
        speed = np.abs(v)
        allowed = np.einsum("nkij,nj,nk->ni", error, speed, speed)
        allowed += 0.5 * np.einsum("nijk,nj,nk->ni", error, speed, speed)
        return derivatives.beyond(subject.coriolis_torque(q, v) - derivatives.christoffel_torque(gradient, v), allowed)
