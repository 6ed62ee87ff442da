"""Every call returns finite numbers wherever the arm may be."""

from __future__ import annotations

from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.subject import NotFinite, Subject

SAMPLES = 512


class FiniteOutput(Check):
    """The suite also hands over what other checks stumble on; see `suite.check`."""

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
        q, v, a = subject.random(SAMPLES, salt=3)
        try:
            for name, arrays in {
                "inverse_dynamics": (q, v, a),
                "mass_matrix": (q,),
                "coriolis_torque": (q, v),
                "gravity_torque": (q,),
            }.items():
                subject.call(name, *arrays)
            subject.residual(q, v, a)
        except NotFinite as found:
            return not_finite(found)
        return Finding(0.0, detail="all sampled values are finite")


def not_finite(found: NotFinite) -> Finding:
    """The finding for one broken call."""
    return Finding(1.0, {"call": found.call, **found.where}, f"{found.call} gives a number that is not finite")
