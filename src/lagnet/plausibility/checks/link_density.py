"""No body is denser than matter: a mass in grams would be."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding, NotApplicable
from lagnet.plausibility.quantities.bodies import Body, moving_bodies
from lagnet.plausibility.subject import Subject

DENSEST = 22_600.0  # [kg/m³] osmium


class LinkDensity(Check):
    """Of all bodies with given mass and moments the sphere needs the least density; even it must be of real matter."""

    name = "link_density"
    title = "masses and inertias are in kilograms"
    meaning = (
        "The mass looks like grams, or its inertia like a placeholder: no matter packs so much into so little space."
    )
    unit = "kg/m³"
    justification = "Osmium, the densest metal, ten times over: placeholders for small parts are often rough."

    def limit(self, subject: Subject) -> float:
        return 10 * DENSEST

    def find(self, subject: Subject) -> Finding:
        heavy = [b for b in moving_bodies(subject) if b.mass > 0 and b.has_inertia]
        if not heavy:
            raise NotApplicable("no body has mass and inertia")
        worst = max(heavy, key=_density)
        detail = (
            f"{worst.name} holds {worst.mass:.4g} kg within {1e3 * worst.radius_of_gyration:.3g} mm; density at least"
        )
        return Finding(_density(worst), worst.where(), detail)


def _density(b: Body) -> float:
    # A solid sphere of radius R has radius of gyration R √(3/5) about its centre.
    radius = b.radius_of_gyration / np.sqrt(0.6)
    return float(b.mass / (4 / 3 * np.pi * radius**3))
