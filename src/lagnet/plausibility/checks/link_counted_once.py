"""No body carries the inertia of the same link twice."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from lagnet.plausibility.check import Check, Finding, NotApplicable
from lagnet.plausibility.quantities.bodies import file_links, moving_bodies
from lagnet.plausibility.subject import Subject
from lagnet.rigid_body.inertia import pseudo_inertia

SAME = 1e-9  # relative: numbers copied from one element of the file to another


class LinkCountedOnce(Check):
    """Two links of one body with the same ten numbers, where the body weighs enough to hold both.

    Files made by converters give the inertia of a link to the link and again to a frame welded onto it. Equal links on
    different joints, or welded side by side as fingers are, are no mistake.
    """

    name = "link_counted_once"
    title = "no inertia is counted twice"
    meaning = "The body is twice as heavy as the real one, because a frame welded to it repeats its inertia."
    unit = "links"
    justification = "Not one may be."

    def limit(self, subject: Subject) -> float:
        return 0.0

    def find(self, subject: Subject) -> Finding:
        links = [link for link in file_links(subject) if link.mass > 0]
        moving = {body.name: body for body in moving_bodies(subject)}
        if not getattr(subject.model, "link_inertials", None):
            raise NotApplicable("the model does not tell its file's links apart")
        twice = []
        for one, other in combinations(links, 2):
            first, second = (one, other) if one.name in moving else (other, one)
            whole = moving.get(first.name)
            if whole is None or second.name in moving or not _same(one.parameters, other.parameters):
                continue
            rest = pseudo_inertia(whole.parameters - 2 * first.parameters)
            size = np.abs(pseudo_inertia(whole.parameters)).max()
            if np.linalg.eigvalsh(rest)[0] >= -SAME * size:
                twice.append((first, second))
        where = twice[0][0].where() | {"repeated_by": twice[0][1].name} if twice else {}
        detail = f"{twice[0][1].name} repeats the inertia of {twice[0][0].name}" if twice else "no link repeats another"
        return Finding(float(len(twice)), where, detail)


def _same(one: np.ndarray, other: np.ndarray) -> bool:
    return bool(np.abs(one - other).max() <= SAME * np.abs(one).max())
