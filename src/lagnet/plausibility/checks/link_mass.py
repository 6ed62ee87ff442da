"""Every moving body has mass, and no link of the file a negative one."""

from __future__ import annotations

from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.quantities.bodies import file_links, moving_bodies
from lagnet.plausibility.subject import Subject


class LinkMass(Check):
    """Frames without mass are welded to bodies in most files: only what moves alone must weigh something."""

    name = "link_mass"
    title = "masses are positive"
    meaning = "A body without mass, or with less than none, makes accelerations without bound."
    unit = "kg"
    justification = "Positive by definition; a milligram is less than any link weighs."
    at_least = True

    def limit(self, subject: Subject) -> float:
        return 1e-6

    def find(self, subject: Subject) -> Finding:
        found = moving_bodies(subject) + [link for link in file_links(subject) if link.mass < 0]
        lightest = min(found, key=lambda b: b.mass)
        return Finding(lightest.mass, lightest.where(), f"mass of {lightest.name}")
