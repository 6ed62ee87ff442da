"""c(q, v) is a quadratic form of v: nothing at rest, four times as much at twice the speed."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import Subject


class CoriolisQuadratic(Check):
    """Holds c(q, 0) = 0, c(q, −v) = c(q, v) and c(q, 2v) = 4 c(q, v)."""

    name = "coriolis_quadratic"
    title = "the Coriolis torque is quadratic in velocity and zero at rest"
    meaning = "A part that is not quadratic is friction, offset or drag that was learned in the wrong place."
    justification = "Exact in mechanics; a thousand roundings are allowed."
    stays_because = (
        "whatever it catches, coriolis_from_mass_matrix catches too, but this one needs no derivative of H and tells "
        "friction learned into c from a wrong H"
    )

    def limit(self, subject: Subject) -> float:
        return subject.at_least_rounding(1e-9)

    def find(self, subject: Subject) -> Finding:
        def missed(q: np.ndarray, v: np.ndarray) -> np.ndarray:
            n = len(q)
            once, back, twice, rest = np.split(
                subject.coriolis_torque(np.tile(q, (4, 1)), np.concatenate([v, -v, 2 * v, 0 * v])), [n, 2 * n, 3 * n]
            )
            parts = np.stack([rest, back - once, (twice - 4 * once) / 4])
            return np.abs(parts / subject.torque_scale).max(axis=(0, 2))

        worst, where = worst_configuration(subject, "qv", missed)
        rest = subject.coriolis_torque(np.array([where["q"]]), np.zeros((1, subject.n_dof)))[0]
        joint = int(np.argmax(np.abs(rest / subject.torque_scale)))
        detail = f"c misses the law of v² by a share of the torque; at rest c of {subject.joints[joint]} is "
        return Finding(worst.value, where, detail + f"{rest[joint]:.3g} {subject.unit('tau', joint)}")
