"""Φ(q, v, a), the functions of motion of the identified layer at each joint, with scales from the recordings."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.problem.problem import Problem
from lagnet.models.corrected.motion_terms import BENDS, OVER_POSITION, MotionTerm

CORE = ("viscous", "dry", "offset", "rotor")  # those of plain least squares: with a wide, fixed prior
GAIN = "gain"  # w of a recorded torque (1 + w) τ: of all joints but one where they are told against each other
PATH = "path"  # friction that changes over the range of a joint
OF_LOAD = ("load", GAIN)  # kinds of functions of the torque of the bodies
LAG = 0.05  # of a period of the bandwidth, by which speed is delayed
BRISTLE = (0.001, 0.006)  # of the range of a joint's motion, over which friction builds up after a reversal
APART = (1, 2)  # joints from one to another that its motor also turns with: the last of a wrist turns with both others
COARSE = 4  # half waves over the range of a joint; shorter ones have a prior of their own
USUAL = 0.98  # quantile of |v| taken for the usual largest speed


@dataclass(frozen=True)
class TermGroup:
    """Functions of motion whose weights have one prior variance.

    Args:
        name: of the group.
        terms: the functions.
        free: whether the prior of the weights is wide and fixed.
        pair: the joints that it couples; None for a group of one joint.
        optional: whether it is used only where it predicts held-out motion better, a pair where far better.
    """

    name: str
    terms: tuple[MotionTerm, ...]
    free: bool = False
    pair: tuple[int, int] | None = None
    optional: bool = False

    @property
    def needs_load(self) -> bool:
        """Whether they are functions of the torque of the bodies, which must be estimated first."""
        return self.terms[0].kind in OF_LOAD

    @property
    def joint(self) -> int | None:
        """The joint of the functions; None for those of a pair."""
        return self.terms[0].joint if self.pair is None else None


def term_groups(problem: Problem) -> tuple[TermGroup, ...]:
    """All groups for the joints of a problem."""
    v = np.concatenate([p.v for p in problem.fit])
    q = np.concatenate([p.q[p.keep] for p in problem.fit])
    low, high = q.min(axis=0), q.max(axis=0)
    speed = np.maximum(np.quantile(np.abs(v), USUAL, axis=0), 1e-9)
    groups = [g for j in range(problem.n_dof) for g in _of_joint(j, float(speed[j]), float(high[j] - low[j]))]
    groups += [g for j in range(problem.n_dof) for g in _over_position(j, float(low[j]), float(high[j]))]
    pairs = ((j - k, j) for k in APART for j in range(k, problem.n_dof))
    return (*groups, *(g for pair in pairs for g in _of_pair(*pair)))


def lag_groups(problem: Problem, joints: Collection[int]) -> tuple[TermGroup, ...]:
    """Delayed speed of joints whose torque has a part in phase with −a, which no rotor can have."""
    return tuple(TermGroup("lag", (MotionTerm("lag", j, LAG / problem.bandwidth),)) for j in sorted(joints))


def _of_joint(j: int, speed: float, reach: float) -> list[TermGroup]:
    return [
        TermGroup("core", tuple(MotionTerm(kind, j) for kind in CORE), free=True),
        TermGroup("curve", tuple(MotionTerm(kind, j, speed) for kind in BENDS)),
        TermGroup("load", (MotionTerm("load", j),)),
        TermGroup(GAIN, (MotionTerm(GAIN, j),), optional=True),
        TermGroup("bristle", tuple(MotionTerm("bristle", j, max(f * reach, 1e-12)) for f in BRISTLE)),
    ]


def _over_position(j: int, low: float, high: float) -> list[TermGroup]:
    """Torque, coarse and fine, and friction that change over the range of a joint."""
    if high <= low:
        return []
    groups: dict[str, list[MotionTerm]] = {}
    for kind, (what, order) in OVER_POSITION.items():
        name = PATH if what != "position" else "position" if order <= COARSE else "fine_position"
        groups.setdefault(name, []).append(MotionTerm(kind, j, (high - low) / 2.0, centre=(high + low) / 2.0))
    return [TermGroup(name, tuple(terms), optional=True) for name, terms in groups.items()]


def _of_pair(first: int, second: int) -> list[TermGroup]:
    """Friction and rotor of a motor that is coupled to two joints: at any ratio, dry friction at ±1."""
    smooth = tuple(MotionTerm(kind, first, other=second) for kind in ("cross_viscous", "cross_inertia"))
    dry = tuple(MotionTerm(kind, first, other=second) for kind in ("cross_dry_sum", "cross_dry_difference"))
    return [TermGroup("tie", terms, pair=(first, second), optional=True) for terms in (smooth, dry)]
