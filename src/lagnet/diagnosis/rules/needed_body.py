"""Bodies that are there although each of their ten parameters may be zero."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.effects.catalogue import effect_named

FAR = 4.0  # times the mean square residual with it, that all other effects must leave at a joint without it


def is_needed_body(candidate: Candidate, n: int) -> bool:
    """Whether effect n is a body, without which all others, refitted, leave mean r² > 4 max(mean r², σ²) at some joint.

    Recordings determine combinations of a body's parameters, the first link's about its axis alone, and neighbouring
    bodies trade mass: by its own interval each parameter could then be zero, though not all of them.
    """
    if not effect_named(candidate.effects[n].effect).is_body:
        return False
    with_it, without = (c.power("fit") for c in (candidate, candidate.without(candidate.indices[n])))
    return bool(np.any(without > FAR * np.maximum(with_it, candidate.noise**2)))
