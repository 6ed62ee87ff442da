"""Bodies that are there although each of their ten parameters may be zero."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.effects.catalogue import effect_named

FAR = 4.0  # times the squared error with it, that all other effects must leave at a joint without it


def is_open(candidate: Candidate, n: int, intervals: Mapping[str, tuple[float, float]]) -> bool:
    """Whether all 95 % intervals of effect n hold the values of its absence, and it is no body that is needed."""
    law = effect_named(candidate.effects[n].effect)
    return not law.is_determined(intervals) and not is_needed_body(candidate, n)


def is_needed_body(candidate: Candidate, n: int) -> bool:
    """Whether effect n is a body, without which all others leave E > 4 max(E, n σ²), where fitted and where held out.

    E is the squared error of a joint.

    Recordings determine combinations of a body's parameters, the first link's about its axis alone, and neighbouring
    bodies trade mass: by its own interval each parameter could then be zero, though not all of them. The others are
    fitted as in the search, bodies free of what is real, so that they leave no more than real ones would.
    """
    if not effect_named(candidate.effects[n].effect).is_body:
        return False
    index = candidate.indices[n]
    found, less = candidate.selection, candidate.without(index).selection
    fitted = less.fit.sse > FAR * np.maximum(found.fit.sse, found.scales.noise_power)
    gain = candidate.holdout_gain[index]
    at = list(gain.at_joints)
    without, with_it = gain.powers
    return bool(np.any(fitted[at] & (without > FAR * np.maximum(with_it, candidate.noise[at] ** 2))))
