"""Another link in the place of one whose fitted parameters belong to no real body, where both are the same torque.

A mass on a joint's axis may be of the link before the joint or of that behind it: the search, which knows no real
bodies, takes either. Of these, one that a real body explains is preferred to all links being free.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.free_bodies import bodies_are_refuted
from lagnet.diagnosis.identifiability.rivals import Comparison
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.selection.arm_search import refit_selection

ALIKE = 1.1  # times the squared error of a joint, up to which two bodies explain the same


def with_real_bodies(candidate: Candidate) -> Candidate:
    """The candidate, with one body exchanged for another that fits as well where that leaves none that is refuted."""
    if not bodies_are_refuted(candidate):
        return candidate
    exchanges = (c for i in _bodies(candidate) for _, c in _exchanges(candidate, i))
    likely = sorted(exchanges, key=lambda c: -c.selection.score)
    return next((c for c in likely if not bodies_are_refuted(c)), candidate)


def with_links_alike(candidate: Candidate, comparisons: Sequence[Comparison]) -> tuple[Comparison, ...]:
    """Comparisons that tell other links whose real change leaves as little as that of the one that was named."""
    library, bodies = candidate.library, _bodies(candidate)
    out = []
    for c in comparisons:
        law, places = library.hypotheses[c.index].law, ()
        if c.index in bodies and law.changes_link:
            others = [(library.hypotheses[k], o) for k, o in _exchanges(candidate, c.index)]
            places = tuple(h.joint for h, o in others if h.law.changes_link and _leaves_as_little(o, candidate))
        out.append(replace(c, elsewhere=places))
    return tuple(out)


def _leaves_as_little(other: Candidate, candidate: Candidate) -> bool:
    floor = np.maximum(candidate.power("fit"), candidate.noise**2)
    return bool(np.all(other.power("fit") <= ALIKE * floor))


def _bodies(candidate: Candidate) -> list[int]:
    return [i for i in candidate.selection.arm_wide if candidate.library.hypotheses[i].law.is_body]


def _exchanges(candidate: Candidate, body: int) -> Iterator[tuple[int, Candidate]]:
    """Hypotheses of another body that leave as little as a selected one in its place, real or not."""
    library, found = candidate.library, candidate.selection
    places = {library.hypotheses[i].place for i in found.arm_wide}
    for k in library.reaching:
        if library.hypotheses[k].law.is_body and library.hypotheses[k].place not in places:
            arm_wide = tuple(k if i == body else i for i in found.arm_wide)
            other = refit_selection(candidate.equations, replace(found, arm_wide=arm_wide))
            floor = np.maximum(found.fit.sse, found.scales.noise_power)
            if np.isfinite(other.score) and np.all(other.fit.sse <= ALIKE * floor):
                yield k, replace(candidate, selection=other)
