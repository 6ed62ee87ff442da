"""Odds of one selection of the whole arm over another, from their errors at all joints in blocks of motion."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.identifiability.block_odds import log10_odds
from lagnet.diagnosis.regression.cross_validation import NormalEquations, unseen_block_errors
from lagnet.diagnosis.selection.arm_search import Selection, least_counted


def odds_over(
    equations: NormalEquations, found: Selection, chosen: tuple[int, ...], instead: tuple[int, ...], simpler: float
) -> float:
    """log10 odds of chosen hypotheses over others in their place, on the scales of a selection.

    Args:
        equations: normal equations of the fitted recordings.
        found: the selection whose residual sets the weight of each joint and the pieces of evidence.
        chosen, instead: hypotheses that are compared, all of the arm.
        simpler: penalty of those in their place less that of the chosen ones [nats].
    """
    sigma = found.sigma(equations)
    here, there = (_block_errors(equations, found, s, sigma) for s in (chosen, instead))
    pieces = equations.samples / found.scales.inefficiency
    return log10_odds(pieces, here, there, least_counted(equations.library, (), found.scales), simpler)


def _block_errors(
    equations: NormalEquations, found: Selection, selection: tuple[int, ...], sigma: np.ndarray
) -> np.ndarray:
    """Squared error of each joint in each block, raised to what counts as evidence together, shape (dof, B) [N² m²]."""
    errors = unseen_block_errors(equations, selection, sigma)
    whole = np.maximum(errors.sum(axis=1), 1e-300)
    return errors * np.maximum(least_counted(equations.library, selection, found.scales) / whole, 1.0)[:, None]
