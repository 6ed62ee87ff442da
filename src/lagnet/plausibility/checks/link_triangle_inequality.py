"""No principal moment of inertia exceeds the sum of the two others."""

from __future__ import annotations

from lagnet.plausibility.check import Check, Finding, NotApplicable
from lagnet.plausibility.quantities.bodies import Body, every_body
from lagnet.plausibility.subject import Subject


class LinkTriangleInequality(Check):
    """The excess of the largest principal moment over the sum of the two smaller ones, as a share of the sum."""

    name = "link_triangle_inequality"
    title = "moments of inertia obey the triangle inequality"
    meaning = "Moments grow by distances in two directions each: one of the three in the file is too large."
    justification = "Not positive for any body; 1e-3 is what moments printed with four digits leave of equality."
    stays_because = (
        "a body that breaks it has no positive pseudo-inertia either; this says by how much, which "
        "moment of the file is too large, and lets thin plates pass"
    )

    def limit(self, subject: Subject) -> float:
        return 1e-3

    def find(self, subject: Subject) -> Finding:
        heavy = [b for b in every_body(subject) if b.mass > 0 and b.has_inertia]
        if not heavy:
            raise NotApplicable("no body has mass and inertia")
        worst = max(heavy, key=_excess)
        small, middle, large = worst.moments
        sign = "<" if _excess(worst) > 0 else "≥"
        detail = f"principal moments of {worst.name} are {small:.4g} + {middle:.4g} {sign} {large:.4g} kg m²; excess"
        return Finding(_excess(worst), worst.where(), detail)


def _excess(b: Body) -> float:
    small, middle, large = b.moments
    pair = small + middle
    return float((large - pair) / max(abs(pair), 1e-9 * abs(large), 1e-300))
