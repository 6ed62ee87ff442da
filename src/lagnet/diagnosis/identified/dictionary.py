"""Φ(q, v, a), the functions of motion of the identified layer at each joint, with scales from the recordings."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.problem.problem import Problem
from lagnet.models.corrected.motion_terms import BENDS, MotionTerm

CORE = ("viscous", "dry", "offset", "rotor")  # those of plain least squares: without a prior
LAG = 0.05  # of a period of the bandwidth, by which speed is delayed
BRISTLE = (0.001, 0.006)  # of the range of a joint's motion, over which friction builds up after a reversal
USUAL = 0.98  # quantile of |v| taken for the usual largest speed


@dataclass(frozen=True)
class TermGroup:
    """Functions of motion whose weights have one prior variance.

    Args:
        name: of the group.
        terms: the functions.
        free: whether the weights have no prior.
        needs_load: whether they are functions of the torque of the bodies, which must be estimated first.
        pair: the joints that it couples; it is used only where it predicts held-out motion far better.
    """

    name: str
    terms: tuple[MotionTerm, ...]
    free: bool = False
    needs_load: bool = False
    pair: tuple[int, int] | None = None

    @property
    def joint(self) -> int | None:
        """The joint of the functions; None for those of a pair."""
        return self.terms[0].joint if self.pair is None else None


def term_groups(problem: Problem) -> tuple[TermGroup, ...]:
    """All groups for the joints of a problem."""
    v = np.concatenate([p.v for p in problem.fit])
    reach = np.ptp(np.concatenate([p.q[p.keep] for p in problem.fit]), axis=0)
    speed = np.maximum(np.quantile(np.abs(v), USUAL, axis=0), 1e-9)
    groups = [g for j in range(problem.n_dof) for g in _of_joint(j, float(speed[j]), float(reach[j]))]
    return (*groups, *(g for j in range(1, problem.n_dof) for g in _of_pair(j - 1, j)))


def lag_groups(problem: Problem, joints: Collection[int]) -> tuple[TermGroup, ...]:
    """Delayed speed of joints whose torque has a part in phase with −a, which no rotor can have."""
    return tuple(TermGroup("lag", (MotionTerm("lag", j, LAG / problem.bandwidth),)) for j in sorted(joints))


def _of_joint(j: int, speed: float, reach: float) -> list[TermGroup]:
    return [
        TermGroup("core", tuple(MotionTerm(kind, j) for kind in CORE), free=True),
        TermGroup("curve", tuple(MotionTerm(kind, j, speed) for kind in BENDS)),
        TermGroup("load", (MotionTerm("load", j),), needs_load=True),
        TermGroup("bristle", tuple(MotionTerm("bristle", j, max(f * reach, 1e-12)) for f in BRISTLE)),
    ]


def _of_pair(first: int, second: int) -> list[TermGroup]:
    """Friction and rotor of a motor that is coupled to two neighbouring joints, at any ratio."""
    smooth = tuple(MotionTerm(kind, first, other=second) for kind in ("cross_viscous", "cross_inertia"))
    dry = tuple(MotionTerm(kind, first, other=second) for kind in ("cross_dry_sum", "cross_dry_difference"))
    return [TermGroup("tie", smooth, pair=(first, second)), TermGroup("tie", dry, pair=(first, second))]
