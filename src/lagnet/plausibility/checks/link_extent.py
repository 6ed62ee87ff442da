"""No body is spread wider than the arm is long: inertia in kg mm² would be."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding, NotApplicable
from lagnet.plausibility.quantities.bodies import moving_bodies, reach
from lagnet.plausibility.subject import Subject

LEAST = 1.0  # [m]


class LinkExtent(Check):
    """Radius of gyration: the root mean square distance of a body's mass from its centre."""

    name = "link_extent"
    title = "inertias are in kilogram square metres"
    meaning = (
        "The inertia looks like kg mm², or belongs to another mass: so little mass would have to reach beyond the arm."
    )
    unit = "m"
    justification = "The length of the arm, or a metre if that is longer: a body's mass lies within its arm."

    def limit(self, subject: Subject) -> float:
        length = reach(subject)
        return max(LEAST, length) if np.isfinite(length) else LEAST

    def find(self, subject: Subject) -> Finding:
        heavy = [b for b in moving_bodies(subject) if b.mass > 0]
        if not heavy:
            raise NotApplicable("no body has mass")
        worst = max(heavy, key=lambda b: b.radius_of_gyration)
        detail = (
            f"{worst.name} of {worst.mass:.4g} kg has moments up to {worst.moments[-1]:.4g} kg m²; radius of gyration"
        )
        return Finding(worst.radius_of_gyration, worst.where(), detail)
