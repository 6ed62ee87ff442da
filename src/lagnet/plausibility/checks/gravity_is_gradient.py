"""g(q) is the gradient of one potential: its Jacobian is symmetric."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.quantities import derivatives
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import Subject


class GravityIsGradient(Check):
    """Entries of the Jacobian are measured against √(τ_i τ_j), torques typical for the two joints."""

    name = "gravity_is_gradient"
    title = "gravity torque is the gradient of a potential"
    meaning = "The arm could gain energy from gravity by going round in a loop."
    justification = "Exact in mechanics; 1e-7 is the error of sixth-order differences."

    def limit(self, subject: Subject) -> float:
        return derivatives.limit(subject)

    def find(self, subject: Subject) -> Finding:
        scale = np.sqrt(np.outer(subject.torque_scale, subject.torque_scale))

        def curl(q: np.ndarray) -> np.ndarray:
            gradient, error = derivatives.position_gradient(subject, subject.gravity_torque, q)
            off, allowed = gradient - gradient.transpose(0, 2, 1), error + error.transpose(0, 2, 1)
            return (derivatives.beyond(off, allowed) / scale).max(axis=(1, 2))

        worst, where = worst_configuration(subject, "q", curl)
        gradient, _ = derivatives.position_gradient(subject, subject.gravity_torque, np.array([where["q"]]))
        off = np.abs(gradient[0] - gradient[0].T) / scale
        i, j = (int(k) for k in np.unravel_index(np.argmax(off), off.shape))
        names = subject.joints
        units = [f"{subject.unit('tau', m)}/{subject.unit('q', k)}" for m, k in ((j, i), (i, j))]
        detail = (
            f"∂g({names[j]})/∂q({names[i]}) = {gradient[0, i, j]:.6g} {units[0]} and ∂g({names[i]})/∂q({names[j]}) = "
        )
        return Finding(worst.value, where, detail + f"{gradient[0, j, i]:.6g} {units[1]}")
