"""Another link in the place of one whose fitted parameters belong to no real body, where both are the same torque.

A mass on a joint's axis may be of the link before the joint or of that behind it: the search, which knows no real
bodies, takes either. Of these, one that a real body explains is preferred to all links being free.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.free_bodies import bodies_are_refuted
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.selection.arm_search import refit_selection


def with_real_bodies(candidate: Candidate) -> Candidate | None:
    """The candidate with one body exchanged for a rival within the odds of a tie, so that no body is refuted.

    None where no exchange will do.
    """
    return next((c for c in _exchanges(candidate) if not bodies_are_refuted(c)), None)


def _exchanges(candidate: Candidate) -> Iterator[Candidate]:
    """Likeliest first."""
    library, found = candidate.library, candidate.selection
    bodies = [i for i in library.reaching if library.hypotheses[i].law.is_body]
    places = {library.hypotheses[i].place for i in found.arm_wide}
    pairs = [(i, k) for i in bodies if i in found.arm_wide for k in bodies if library.hypotheses[k].place not in places]
    others = [
        refit_selection(candidate.equations, replace(found, arm_wide=tuple(k if j == i else j for j in found.arm_wide)))
        for i, k in pairs
    ]
    for other in sorted(others, key=lambda s: -s.score):
        if (found.score - other.score) / np.log(10.0) < candidate.limits.tie_odds:
            yield replace(candidate, selection=other)
