"""Some distribution of mass in space has the moments that the file gives."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding, NotApplicable
from lagnet.plausibility.quantities.bodies import Body, every_body
from lagnet.plausibility.subject import Subject


class LinkPseudoInertia(Check):
    """Smallest second moment of the mass about its centre, over the largest. Source: Wensing et al. 2018."""

    name = "link_pseudo_inertia"
    title = "inertias belong to bodies"
    meaning = "No body of matter has these moments of inertia; energies and identification with them go wrong."
    justification = (
        "Positive by definition; 1e-6 of the largest moment is a plate a thousandth as thick as it is wide, "
        "thinner than links are, and what six printed digits leave of zero."
    )
    at_least = True

    def limit(self, subject: Subject) -> float:
        return 1e-6

    def find(self, subject: Subject) -> Finding:
        heavy = [b for b in every_body(subject) if b.mass > 0 and b.has_inertia]
        if not heavy:
            raise NotApplicable("no body has mass and inertia")
        worst = min(heavy, key=_thinness)
        xx, yy, zz = worst.moments
        detail = (
            f"principal moments of {worst.name} are {xx:.4g}, {yy:.4g}, {zz:.4g} kg m²; thinnest second moment of mass"
        )
        return Finding(_thinness(worst), worst.where(), detail + " over the largest")


def _thinness(b: Body) -> float:
    second = np.sort(0.5 * b.moments.sum() - b.moments)
    return float(second[0] / max(np.abs(second).max(), 1e-300))
