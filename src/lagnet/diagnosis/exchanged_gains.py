"""Bodies alone in the place of bodies beside the gains of half of the joints, where they tell as much of unseen motion.

On the fitted motion a gain a joint has the greater log P where several links differ a little from their model: it takes
a share of each. What sensors do acts on the next motion as well, and a load says more than gains and links together.
"""

from __future__ import annotations

from dataclasses import replace

from lagnet.diagnosis.free_bodies import are_scaled_widely, bodies_are_refuted, log_error
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.selection.gain_exchange import without_gains
from lagnet.diagnosis.unexplained.remainder import remainder_of


def without_wide_gains(candidate: Candidate) -> Candidate:
    """The candidate, or the likeliest one without its gains whose real bodies leave no more on held-out motion."""
    if not are_scaled_widely(candidate):
        return candidate
    likely = sorted(without_gains(candidate.equations, candidate.selection), key=lambda found: -found.score)
    others = (replace(candidate, selection=found, start=()) for found in likely)
    most = _unseen_error(candidate)
    return next((c for c in others if not bodies_are_refuted(c) and _unseen_error(c) <= most), candidate)


def _unseen_error(candidate: Candidate) -> float:
    return log_error(remainder_of(candidate.problem, candidate.effects), candidate.noise)
