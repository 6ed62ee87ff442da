"""F [Y Φ] x = F r, the linear system of the identified layer: filtered columns of all joints over one vector x."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lagnet.diagnosis.identified.dictionary import USUAL, TermGroup
from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.models.corrected.motion_terms import MotionTerm, Rest
from lagnet.rigid_body.inertia import BODY
from lagnet.types import Trajectory

RESTING = 0.01  # of a joint's usual largest speed: below, it is at rest
FEWEST = 12  # filtered samples in motion, three for each function of plain least squares: fewer say nothing of a joint
ROUNDING = 1e-9  # of the largest column: a smaller one is zero


@dataclass(frozen=True, eq=False)
class Group:
    """Unknowns with one prior variance.

    Args:
        name: of the functions of motion, "bodies" for inertial parameters.
        unknowns: shape (k,), their indices in x.
        free: whether their prior is a wide one that nothing changes.
        joint: the joint whose functions they weight; None for bodies and pairs.
        pair: the two joints that they couple; None for all others.
        optional: whether they are used only where held-out motion is predicted better with them.
    """

    name: str
    unknowns: np.ndarray
    free: bool
    joint: int | None = None
    pair: tuple[int, int] | None = None
    optional: bool = False


@dataclass(frozen=True, eq=False)
class JointRows:
    """The equations of one joint, low-passed and decimated: columns · unknowns = target.

    Args:
        columns: shape (n, p), scaled to unit size.
        target: shape (n,), residual of the named model [N m].
        valid: shape (n,), False where the joint is at rest and dry friction may take any value.
        unknowns: shape (p,), index in x of each column.
    """

    columns: np.ndarray
    target: np.ndarray
    valid: np.ndarray
    unknowns: np.ndarray


@dataclass(frozen=True, eq=False)
class Design:
    """All joints' equations.

    Args:
        joints: equations of each joint.
        groups: unknowns by their prior; bodies first.
        terms: functions of motion in the order of their unknowns, after the bodies'.
        n_bodies: number of unknowns that are inertial parameters.
        scale: shape (n_unknowns,), by which columns were divided; 0 for a column of zeros.
        piece: shape (n,), index of the piece of motion of each row.
    """

    joints: tuple[JointRows, ...]
    groups: tuple[Group, ...]
    terms: tuple[MotionTerm, ...]
    n_bodies: int
    scale: np.ndarray
    piece: np.ndarray

    @property
    def n_unknowns(self) -> int:
        """Length of the vector of unknowns."""
        return self.scale.size

    def without(self, unknowns: np.ndarray) -> Design:
        """The same equations with some unknowns fixed at zero."""
        scale = self.scale.copy()
        scale[unknowns] = 0.0
        return replace(self, joints=tuple(_scaled(j, np.where(scale > 0, 1.0, 0.0)) for j in self.joints), scale=scale)

    def unscaled(self, x: np.ndarray) -> np.ndarray:
        """Unknowns in SI units from those of scaled columns; zero for a column of zeros."""
        return np.where(self.scale > 0, x / np.where(self.scale > 0, self.scale, 1.0), 0.0)


@dataclass(frozen=True, eq=False)
class FitSegment:
    """A segment of fitted motion.

    Args:
        piece: the segment.
        regressor: Y, shape (n, dof, 10 dof); None without bodies.
        load: shape (n, dof), torque of the bodies as far as known [N m].
        target: shape (n, dof), residual of the named model [N m].
    """

    piece: Segment
    regressor: np.ndarray | None
    load: Trajectory
    target: Trajectory


def make_design(problem: Problem, segments: Sequence[FitSegment], groups: Sequence[TermGroup]) -> Design:
    """Columns of the bodies and of the groups' functions at every joint.

    Args:
        problem: gives filter and motion.
        segments: those that are fitted.
        groups: functions of motion.
    """
    terms = tuple(t for g in groups for t in g.terms)
    n_bodies = BODY * problem.n_dof if segments[0].regressor is not None else 0
    rows = [_joint_rows(problem, segments, j, terms, n_bodies) for j in range(problem.n_dof)]
    scale = _scales(problem, rows, n_bodies + len(terms))
    joints = tuple(_scaled(r, scale) for r in rows)
    piece = np.concatenate([np.full(s.piece.keep.size, i) for i, s in enumerate(segments)])
    return Design(joints, _groups(groups, n_bodies), terms, n_bodies, scale, piece)


def usual_rest(problem: Problem) -> Rest:
    """Rest below a hundredth of the usual largest speed; all of the bristles' torque stays until it is estimated."""
    speed = np.quantile(np.abs(np.concatenate([p.v for p in problem.fit])), USUAL, axis=0)
    return Rest(np.minimum(problem.slow, RESTING * speed), np.ones(problem.n_dof))


def _groups(groups: Sequence[TermGroup], n_bodies: int) -> tuple[Group, ...]:
    out = [Group("bodies", np.arange(n_bodies), False)] if n_bodies else []
    start = n_bodies
    for group in groups:
        unknowns = np.arange(start, start + len(group.terms))
        out.append(Group(group.name, unknowns, group.free, group.joint, group.pair, group.optional))
        start += len(group.terms)
    return tuple(out)


def _joint_rows(
    problem: Problem, segments: Sequence[FitSegment], joint: int, terms: Sequence[MotionTerm], n_bodies: int
) -> JointRows:
    own, rest = [i for i, t in enumerate(terms) if joint in t.rows], usual_rest(problem)
    links = np.arange(BODY * joint, n_bodies)  # links before a joint have no torque at it
    columns = []
    for s in segments:
        motion: Any = s.piece.motion(problem)
        parts = [] if s.regressor is None else [s.regressor[:, joint, links]]
        parts += [terms[i].at(joint, motion, s.load, rest)[:, None] for i in own]
        columns.append(problem.reduce(s.piece, np.hstack(parts)))
    target = np.concatenate([problem.reduce(s.piece, s.target[:, [joint]])[:, 0] for s in segments])
    valid = np.concatenate([s.piece.counts[:, joint] for s in segments])
    return JointRows(np.vstack(columns), target, valid, np.concatenate([links, n_bodies + np.array(own)]).astype(int))


def _scales(problem: Problem, rows: Sequence[JointRows], n: int) -> np.ndarray:
    """max_j rms(column) / σ_τj of each column over the joints that tell something, shape (n,)."""
    scale = np.zeros(n)
    for joint, r in enumerate(rows):
        told = r.columns[r.valid] if r.valid.sum() >= FEWEST else np.zeros((1, r.unknowns.size))
        size = np.sqrt(np.mean(told**2, axis=0))
        scale[r.unknowns] = np.maximum(scale[r.unknowns], size / max(float(problem.scale[joint]), 1e-12))
    return np.where(scale > ROUNDING * scale.max(initial=0.0), scale, 0.0)


def _scaled(rows: JointRows, scale: np.ndarray) -> JointRows:
    own = scale[rows.unknowns]
    columns = np.where(own > 0, rows.columns / np.where(own > 0, own, 1.0), 0.0)
    return JointRows(columns, rows.target, rows.valid, rows.unknowns)
