"""The identified layer beside the named effects, or in their place where their values hinder it.

Names are claims with parameters of their own. Where a name holds a part of what another cause does, as a gain does of
links that differ, a layer that is fitted beside its fixed value cannot take that back. Held-out blocks of the fitted
recordings decide: they have been seen by the names' parameters, and by nothing of the other layer's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.identified.evidence import joint_equations
from lagnet.diagnosis.identified.fit import Identified, identify
from lagnet.diagnosis.problem.problem import Problem
from lagnet.models.corrected.named_effects import NamedEffect, torque_with, transients_among

LESS = np.log(0.9)  # mean over joints of ln(error in place of the names / error beside them), below which it is used


def instead_of_names(problem: Problem, effects: Sequence[NamedEffect], beside: Identified | None) -> Identified | None:
    """The layer without the effects that always act, where it predicts unseen blocks better than with them; else None.

    Args:
        problem: the diagnosis' problem.
        effects: named physics.
        beside: the layer beside all of it; None where it predicts nothing more.
    """
    rest = transients_among(effects)
    alone = identify(problem, rest) if len(rest) < len(effects) else None
    if alone is None:
        return None
    with_names = _error_of(problem, effects) if beside is None else _block_error(beside)
    ratio = np.maximum(_block_error(alone), 1e-300) / np.maximum(with_names, 1e-300)
    return alone if np.mean(np.log(ratio)) < LESS else None


def _block_error(found: Identified) -> np.ndarray:
    """Mean square residual of each joint on held-out blocks, shape (dof,) [N² m²]."""
    power = np.array([joint.power for joint in joint_equations(found.design)])
    return found.choice.nmse * power / np.array([max(1, joint.valid.sum()) for joint in found.design.joints])


def _error_of(problem: Problem, effects: Sequence[NamedEffect]) -> np.ndarray:
    """Mean square residual of each joint with the named effects alone, shape (dof,) [N² m²]."""
    motions = [replace(p.motion(problem), recorded=None) for p in problem.fit]
    left = [problem.reduce(p, p.tau - torque_with(m, effects)) for p, m in zip(problem.fit, motions, strict=True)]
    counts = np.concatenate([p.counts for p in problem.fit])
    return np.sum((np.concatenate(left) * counts) ** 2, axis=0) / np.maximum(1, counts.sum(axis=0))
