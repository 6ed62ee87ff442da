"""Every call returns finite numbers wherever the arm may be."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.calling import NotFinite
from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import Subject

SAMPLES = 512


class FiniteOutput(Check):
    """The local search climbs to where torque is largest, as numbers overflow there first.

    The suite also hands over what other checks stumble on; see `suite.check`.
    """

    name = "finite_output"
    title = "every call returns finite numbers"
    meaning = "A number that is not finite ends a simulation and poisons whatever is fitted to it."
    unit = "calls"
    justification = "Not one may be broken."
    stays_because = (
        "a number that is not finite stops other checks, which then do not apply; bounded_growth may meet it as well"
    )

    def limit(self, subject: Subject) -> float:
        return 0.0

    def find(self, subject: Subject) -> Finding:
        try:
            _torque(subject, *subject.random(SAMPLES, salt=3))
            worst_configuration(subject, "qva", lambda q, v, a: _torque(subject, q, v, a))
        except NotFinite as found:
            return not_finite(found)
        return Finding(0.0, detail="all values looked at are finite")


def _torque(subject: Subject, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Largest torque of any joint over its typical one, shape (n,), after a look at every call.

    Raises:
        NotFinite: a call gives a number that is not finite.
    """
    subject.mass_matrix(q)
    subject.coriolis_torque(q, v)
    subject.gravity_torque(q)
    subject.residual(q, v, a)
    return np.abs(subject.torque(q, v, a) / subject.torque_scale).max(axis=1)


def not_finite(found: NotFinite) -> Finding:
    """The finding for one broken call."""
    return Finding(1.0, {"call": found.call, **found.where}, f"{found.call} gives a number that is not finite")
