"""h = Σ r c / Σ c² over samples at rest, c the full dry friction: the share of it that each joint keeps at rest.

Estimated from samples at rest, which no law is fitted on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.estimation.gauss_newton import spread
from lagnet.diagnosis.problem.problem import Problem
from lagnet.models.corrected.named_effects import NamedEffect, torque_with

FEW = 20  # samples at rest, below which the share is not estimated


def friction_at_rest(problem: Problem, effects: Sequence[NamedEffect]) -> np.ndarray:
    """Share of the dry friction that stays at rest, shape (dof,), 0 to 1; 0 where the recordings do not show it."""
    n = problem.n_dof
    product, power, count = np.zeros(n), np.zeros(n), np.zeros(n)
    for piece in spread(problem.fit):
        motion = replace(piece.motion(problem), held=None)
        without = torque_with(motion, effects)
        fully = torque_with(replace(motion, held=np.ones(n)), effects)
        resting = ~piece.counts
        residual = problem.reduce(piece, piece.tau - without) * resting
        change = problem.reduce(piece, fully - without) * resting
        product += np.sum(residual * change, axis=0)
        power += np.sum(change**2, axis=0)
        count += resting.sum(axis=0)
    shown = (count >= FEW) & (power > 0)
    return np.where(shown, np.clip(product / np.where(power > 0, power, 1.0), 0.0, 1.0), 0.0)
