"""Ḣ − 2C is skew: Coriolis torques do no work beyond what the changing inertia accounts for."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.quantities import derivatives
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import Subject


class CoriolisSkewSymmetric(Check):
    """With a `coriolis_matrix` of its own the whole matrix is held; without, the power vᵀ(Ḣ v − 2 c)."""

    name = "coriolis_skew_symmetric"
    title = "Ḣ − 2C is skew-symmetric"
    meaning = "Controllers that rely on passivity, and energy itself, break where it is not."
    justification = "Exact with Christoffel symbols; 1e-7 is the error of sixth-order differences."

    def limit(self, subject: Subject) -> float:
        return derivatives.limit(subject)

    def find(self, subject: Subject) -> Finding:
        measure = self._matrix if subject.offers("coriolis_matrix") else self._power
        worst, where = worst_configuration(subject, "qv", lambda q, v: measure(subject, q, v))
        what = (
            "largest entry of the symmetric part of Ḣ − 2C, or of C v − c"
            if measure == self._matrix
            else ("power vᵀ(Ḣ v − 2c) over that of typical torques")
        )
        return Finding(worst.value, where, what)

    @staticmethod
    def _matrix(subject: Subject, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        C = subject.call("coriolis_matrix", q, v)
        rate, error = derivatives.along(subject, subject.mass_matrix, q, v)
        symmetric = rate - C - C.transpose(0, 2, 1)
        speed = np.maximum(np.abs(v).max(axis=1), 1e-3 * subject.ranges.velocity.max())
        scale = np.sqrt(np.outer(subject.inertia_scale, subject.inertia_scale)) * speed[:, None, None]
        skew = (derivatives.beyond(symmetric, error) / scale).max(axis=(1, 2))
        product = np.einsum("nij,nj->ni", C, v) - subject.coriolis_torque(q, v)
        return np.maximum(skew, np.abs(product / subject.torque_scale).max(axis=1))

    @staticmethod
    def _power(subject: Subject, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        rate, error = derivatives.along(subject, subject.mass_matrix, q, v)
        power = np.einsum("ni,nij,nj->n", v, rate, v) - 2 * np.einsum("ni,ni->n", v, subject.coriolis_torque(q, v))
        allowed = np.einsum("ni,nij,nj->n", np.abs(v), error, np.abs(v))
        return derivatives.beyond(power, allowed) / (subject.torque_scale @ subject.ranges.velocity)
