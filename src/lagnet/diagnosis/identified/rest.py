"""How much of the torque of bent bristles each joint keeps while it rests, from samples that nothing is fitted on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.identified.design import Seen
from lagnet.diagnosis.problem.problem import Problem
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.motion_terms import Rest

FEW = 8  # resting samples below which nothing is said


def friction_at_rest(problem: Problem, seen: Sequence[Seen], layer: IdentifiedLayer) -> Rest:
    """The layer's rest with the share of what bent bristles hold that stays; all where recordings do not show it.

    Args:
        problem: gives filter and motion.
        seen: the fitted pieces, under the load that the layer was estimated with.
        layer: the layer with all of it.
    """
    parts = [_at_rest(problem, s, layer) for s in seen]
    left, held, resting = (np.concatenate(x) for x in zip(*parts, strict=True))
    power = np.sum(held**2 * resting, axis=0)
    share = np.sum(left * held * resting, axis=0) / np.where(power > 0, power, 1.0)
    shown = (resting.sum(axis=0) >= FEW) & (power > 0)
    return replace(layer.rest, held=np.where(shown, np.clip(share, 0.0, 1.0), layer.rest.held))


def _at_rest(problem: Problem, s: Seen, layer: IdentifiedLayer) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What is left if bristles hold nothing at rest, what they would hold, and which samples rest, each (n, dof)."""
    motion = s.piece.motion(problem)
    fully = layer.term_torque(motion, s.load)
    without = replace(layer, rest=replace(layer.rest, held=np.zeros(problem.n_dof))).term_torque(motion, s.load)
    bodies = np.zeros_like(without)
    if s.regressor is not None and layer.bodies is not None:
        bodies = s.regressor @ layer.bodies.ravel()
    left = problem.reduce(s.piece, s.target - bodies - without)
    return left, problem.reduce(s.piece, fully - without), ~s.piece.counts
