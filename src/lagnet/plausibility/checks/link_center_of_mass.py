"""No centre of mass lies farther from its joint than the arm is long."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.quantities.bodies import every_body, reach
from lagnet.plausibility.subject import Subject

LEAST = 1.0  # [m]


class LinkCenterOfMass(Check):
    """Distance of the centre of mass from the origin of the link's frame."""

    name = "link_center_of_mass"
    title = "centres of mass lie in the arm"
    meaning = "The centre of mass was given in millimetres, or in another frame."
    unit = "m"
    justification = "The length of the arm, or a metre if that is longer: millimetres taken as metres are far beyond."

    def limit(self, subject: Subject) -> float:
        length = reach(subject)
        return max(LEAST, length) if np.isfinite(length) else LEAST

    def find(self, subject: Subject) -> Finding:
        worst = max(every_body(subject), key=lambda b: float(np.linalg.norm(b.com)))
        x, y, z = worst.com
        detail = f"centre of mass of {worst.name} is at ({x:.4g}, {y:.4g}, {z:.4g}) m, distance from its frame"
        return Finding(float(np.linalg.norm(worst.com)), worst.where(), detail)
