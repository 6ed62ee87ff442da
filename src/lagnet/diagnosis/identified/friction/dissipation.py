"""W = Σ_t v_t f_t ≥ 0: friction takes work from a joint, or the joint has none.

Where a joint turns one way for most of a few seconds, dry friction and an offset are nearly one column. Their
difference may then be large and of either sign, and friction that drives the joint predicts no other motion. Bristles
of positive stiffness, which give back what they took before, stay.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from lagnet.diagnosis.identified.design import Design
from lagnet.diagnosis.identified.folds import Choice
from lagnet.diagnosis.problem.problem import Problem
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.motion_terms import BENDS
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.types import is_robot_model

FRICTION = ("viscous", "dry", "load", "bristle", *BENDS)  # of a joint's own speed
DRIVES = 0.01  # of |v| |τ|, work that friction may give: rounding and noise of a joint without friction


def with_friction(problem: Problem, effects: Sequence[NamedEffect]) -> set[int]:
    """Joints of whose friction a part is modelled or named: the layer may take some of it back."""
    if isinstance(problem.nominal, CorrectedModel) or not is_robot_model(problem.nominal):
        return set(range(problem.n_dof))
    return {e.joint for e in effects if e.joint is not None and effect_named(e.effect).is_friction}


def driving_friction(design: Design, choice: Choice, spared: Collection[int]) -> np.ndarray:
    """Unknowns of friction that gives work to its joint, where all friction of that joint together gives work.

    Args:
        design: the equations.
        choice: the solution.
        spared: joints that are not asked, since the layer does not have all of their friction.
    """
    driving = []
    for j, rows in enumerate(design.joints):
        own = {i: t for i, t in enumerate(design.terms, design.n_bodies) if t.joint == j and t.kind in FRICTION}
        speed = next((i for i, t in own.items() if t.kind == "viscous"), None)
        if speed is None or j in spared:
            continue
        columns, target = rows.columns[rows.valid], rows.target[rows.valid]
        v = columns[:, rows.unknowns == speed][:, 0]
        work = dict(zip(rows.unknowns.tolist(), (v @ columns) * choice.ridge.x[rows.unknowns], strict=True))
        if sum(work[i] for i in own) < -DRIVES * np.linalg.norm(v) * np.linalg.norm(target):
            stored = {i for i, t in own.items() if t.kind == "bristle" and choice.ridge.x[i] > 0.0}
            driving += [i for i in own if work[i] < 0.0 and i not in stored]
    return np.array(driving, dtype=int)
