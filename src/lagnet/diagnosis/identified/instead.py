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


def instead_of_names(
    problem: Problem, effects: Sequence[NamedEffect], beside: Identified | None, floor: np.ndarray | float = 0.0
) -> Identified | None:
    """The layer without the effects that always act, where it predicts unseen blocks better than with them; else None.

    Args:
        problem: the diagnosis' problem.
        effects: named physics.
        beside: the layer beside all of it; None where it predicts nothing more.
        floor: shape (dof,), error that noise alone leaves [N m]: no layer is sought where none could be so much better.
    """
    rest = transients_among(effects)
    with_names = np.maximum(_error_of(problem, effects) if beside is None else _block_error(beside), 1e-300)
    if len(rest) == len(effects) or not _is_better(np.minimum(np.square(floor), with_names), with_names):
        return None
    alone = identify(problem, rest)
    return alone if alone is not None and _is_better(_block_error(alone), with_names) else None


def _is_better(error: np.ndarray, other: np.ndarray) -> bool:
    """Whether one mean square error (dof,) is less than another by `LESS` in the mean of its logarithm."""
    return bool(np.mean(np.log(np.maximum(error, 1e-300) / other)) < LESS)


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
