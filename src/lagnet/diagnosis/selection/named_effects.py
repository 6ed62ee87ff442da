"""A selection of hypotheses as effects of the catalogue with physical parameters."""

from __future__ import annotations

from lagnet.diagnosis.regression.library import Library
from lagnet.diagnosis.selection.arm_search import Selection
from lagnet.models.corrected.named_effects import NamedEffect


def named_effects(library: Library, found: Selection) -> tuple[NamedEffect, ...]:
    """The selection as effects with the search's parameters, in the order of the selection."""
    out = []
    for i in found.indices:
        h = library.hypotheses[i]
        values = h.law.values(found.fit.coefficients[i], dict(h.shape))
        out.append(NamedEffect(h.effect, h.joint, values, modelled=h.modelled))
    return tuple(out)
