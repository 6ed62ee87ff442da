"""Every body with mass has moments of inertia: none was left at zero."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding, NotApplicable
from lagnet.plausibility.quantities.bodies import LEAST_INERTIA, Body, every_body
from lagnet.plausibility.subject import Subject

LIGHTEST = 1e-6  # [kg] frames of files carry a token mass without meaning


class LinkInertiaGiven(Check):
    """Largest principal moment about the centre of mass."""

    name = "link_inertia_given"
    title = "no inertia was left at zero"
    meaning = "A mass without extent has no inertia of its own: the field in the file was left empty."
    unit = "kg m²"
    justification = "A hundredth of a gram square millimetre (1e-14 kg m²) is less than any link that moves has."
    at_least = True

    def limit(self, subject: Subject) -> float:
        return LEAST_INERTIA

    def find(self, subject: Subject) -> Finding:
        heavy = [b for b in every_body(subject) if b.mass > LIGHTEST]
        if not heavy:
            raise NotApplicable("no body has mass")
        worst = min(heavy, key=_largest)
        return Finding(
            _largest(worst), worst.where(), f"largest moment of inertia of {worst.name}, {worst.mass:.4g} kg"
        )


def _largest(b: Body) -> float:
    return float(np.abs(b.moments).max())
