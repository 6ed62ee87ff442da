"""Every motion has positive kinetic energy: all eigenvalues of H(q) are positive."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import Subject


class MassMatrixPositiveDefinite(Check):
    """Searches for the smallest eigenvalue of the symmetric part of H."""

    name = "mass_matrix_positive_definite"
    title = "the mass matrix is positive definite"
    meaning = "Some motion would have no or negative kinetic energy there, and forward dynamics would blow up."
    unit = "kg m²"
    justification = "Positive by definition; 1e-13 of the largest eigenvalue is what rounding leaves of a zero."
    at_least = True

    def limit(self, subject: Subject) -> float:
        return 0.0

    def find(self, subject: Subject) -> Finding:
        # Scaled by the typical diagonal for the search: a light wrist must not hide behind a heavy shoulder.
        scale = np.sqrt(np.outer(subject.inertia_scale, subject.inertia_scale))

        def deficit(q: np.ndarray) -> np.ndarray:
            return -np.linalg.eigvalsh(_symmetric(subject.mass_matrix(q)) / scale)[:, 0]

        worst, where = worst_configuration(subject, "q", deficit)
        H = _symmetric(subject.mass_matrix(np.array([where["q"]])))[0]
        values, vectors = np.linalg.eigh(H)
        weakest = subject.joints[int(np.argmax(np.abs(vectors[:, 0])))]
        limit = 1e-13 * max(abs(values[-1]), abs(values[0]))
        value = float(values[0]) if -worst.value > 0 or values[0] < 0 else float(-worst.value)
        detail = f"eigenvalues of H from {values[0]:.3g} to {values[-1]:.3g} kg m², smallest mostly in {weakest}"
        return Finding(value, where, detail, limit=limit)


def _symmetric(H: np.ndarray) -> np.ndarray:
    return 0.5 * (H + H.transpose(0, 2, 1))
