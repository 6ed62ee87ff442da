"""τ(q, v, a) − τ(q, v, 0) is H(q) a."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import Subject


class TorqueAffineInAcceleration(Check):
    """The part ε that a model sets apart is taken off first: it may do as it likes."""

    name = "torque_affine_in_acceleration"
    title = "torque is affine in acceleration with slope H"
    meaning = "Twice the acceleration asks for twice the inertial torque, and for that of the model's own mass matrix."
    justification = "Exact in mechanics; a thousand roundings are allowed."

    def limit(self, subject: Subject) -> float:
        return subject.at_least_rounding(1e-9)

    def find(self, subject: Subject) -> Finding:
        def missed(q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
            rise = subject.mechanical_torque(q, v, a) - subject.mechanical_torque(q, v, np.zeros_like(a))
            off = rise - np.einsum("nij,nj->ni", subject.mass_matrix(q), a)
            return np.abs(off / subject.torque_scale).max(axis=1)

        worst, where = worst_configuration(subject, "qva", missed)
        return Finding(worst.value, where, "τ(q, v, a) − τ(q, v, 0) differs from H a by a share of the joint's torque")
