"""H(q) equals its transpose."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import Subject


class MassMatrixSymmetric(Check):
    """Entries are measured against √(H_ii H_jj), so that turning and sliding joints weigh alike."""

    name = "mass_matrix_symmetric"
    title = "the mass matrix is symmetric"
    meaning = "Kinetic energy has one value only if joint i feels joint j as j feels i."
    justification = "Exact in mechanics; a thousand roundings are allowed."
    stays_because = (
        "an arm whose torque follows an asymmetric H also breaks the energy balance; this names the two entries, and "
        "needs no motion"
    )

    def limit(self, subject: Subject) -> float:
        return subject.at_least_rounding(1e-9)

    def find(self, subject: Subject) -> Finding:
        scale = np.sqrt(np.outer(subject.inertia_scale, subject.inertia_scale))

        def asymmetry(q: np.ndarray) -> np.ndarray:
            H = subject.mass_matrix(q)
            return np.abs((H - H.transpose(0, 2, 1)) / scale).max(axis=(1, 2))

        worst, where = worst_configuration(subject, "q", asymmetry)
        H = subject.mass_matrix(np.array([where["q"]]))[0]
        i, j = (int(k) for k in np.unravel_index(np.argmax(np.abs((H - H.T) / scale)), H.shape))
        names = subject.joints
        detail = f"H({names[i]}, {names[j]}) = {H[i, j]:.6g} and H({names[j]}, {names[i]}) = {H[j, i]:.6g} kg m²"
        return Finding(worst.value, where, detail)
