"""Every body has the mass, centre of mass and inertia that the reference gives it."""

from __future__ import annotations

import numpy as np

from lagnet.decomposition.offers import offers
from lagnet.plausibility.check import Check, Finding, NotApplicable
from lagnet.plausibility.quantities.bodies import Body, body, moving_bodies
from lagnet.plausibility.subject import Subject


class ReferenceBodies(Check):
    """Largest difference of a body's mass, first moment or inertia, as a share of the reference's."""

    name = "reference_bodies"
    title = "bodies agree with the reference"
    meaning = "A link of the model differs from that of the reference, though torque may hardly show it."
    justification = "Nine digits: what files print. Halves, doubles and thousands stand out in the value."

    def limit(self, subject: Subject) -> float:
        return 1e-9

    def find(self, subject: Subject) -> Finding:
        if subject.reference is None or not offers(subject.reference, "inertial_parameters"):
            raise NotApplicable("no reference made of bodies was given")
        own = moving_bodies(subject)
        rows = np.asarray(subject.reference.inertial_parameters(), dtype=float)
        pairs = [(mine, body(mine.name, mine.joint, row)) for mine, row in zip(own, rows, strict=True)]
        found = [(_differences(*pair), pair) for pair in pairs]
        differences, (mine, theirs) = max(found, key=lambda f: max(f[0].values()))
        what = max(differences, key=lambda name: differences[name])
        detail = f"{what} of {mine.name} differs by this share of the reference's (mass {mine.mass:.6g} and "
        return Finding(differences[what], mine.where(), detail + f"{theirs.mass:.6g} kg)")


def _differences(mine: Body, theirs: Body) -> dict[str, float]:
    """Relative difference of mass, first moment and inertia about the origin."""
    d, size = np.abs(mine.parameters - theirs.parameters), np.abs(theirs.parameters)
    extent = max(theirs.radius_of_gyration, float(np.linalg.norm(theirs.com)), 1e-9) if theirs.mass > 0 else 1.0
    return {
        "mass": float(d[0] / max(size[0], 1e-12)),
        "first moment": float(d[1:4].max() / max(size[0] * extent, 1e-12)),
        "inertia": float(d[4:].max() / max(size[4:].max(), 1e-15)),
    }
