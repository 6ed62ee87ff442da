"""argmin_s |r − s b|² at rest: the share s of the bristles' torque b that stays, from samples that are not fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.identified.design import FitSegment
from lagnet.diagnosis.problem.problem import Problem
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.motion_terms import Rest

FEW = 8  # samples at rest below which s is not estimated
UNKNOWN = 0.5  # s where recordings do not show it: the error is least in the worse case


def friction_at_rest(problem: Problem, segments: Sequence[FitSegment], layer: IdentifiedLayer) -> Rest:
    """The layer's rest with the estimated share; a half where recordings do not show it.

    Args:
        problem: gives filter and motion.
        segments: fitted motion, with the load that the layer was estimated with.
        layer: the layer with a share of 1.
    """
    parts = [_at_rest(problem, s, layer) for s in segments]
    residual, held, resting = (np.concatenate(x) for x in zip(*parts, strict=True))
    power = np.sum(held**2 * resting, axis=0)
    share = np.sum(residual * held * resting, axis=0) / np.where(power > 0, power, 1.0)
    shown = (resting.sum(axis=0) >= FEW) & (power > 0)
    return replace(layer.rest, held=np.where(shown, np.clip(share, 0.0, 1.0), UNKNOWN))


def _at_rest(problem: Problem, s: FitSegment, layer: IdentifiedLayer) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Residual without bristles at rest, torque of the bristles, and mask of samples at rest, each (n, dof)."""
    motion = s.piece.motion(problem)
    fully = layer.term_torque(motion, s.load)
    without = replace(layer, rest=replace(layer.rest, held=np.zeros(problem.n_dof))).term_torque(motion, s.load)
    bodies = np.zeros_like(without)
    if s.regressor is not None and layer.bodies is not None:
        bodies = s.regressor @ layer.bodies.ravel()
    residual = problem.reduce(s.piece, s.target - bodies - without)
    return residual, problem.reduce(s.piece, fully - without), ~s.piece.counts
