"""Held-out scores with and without a surface, in the blocks of time in which it changes the predicted motion.

A surface says nothing of motion that stays above it: over all blocks even a table that stops the arm would gain little.
Which blocks count is said by the two predictions alone, before either is held against what was measured.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.motion.arm.rollouts import ArmRuns
from lagnet.diagnosis.motion.joint.block_scores import advantage
from lagnet.diagnosis.motion.joint.joint_case import SelectionLimits
from lagnet.diagnosis.motion.surface.free_motion import FreeMotion
from lagnet.rigid_body.kinematic_tree import KinematicTree
from lagnet.rollout.surface import heights_of, levers_of

LEAST_BLOCKS = 6  # of time in contact that evidence rests on
LEAST_JOINTS = 2  # that it moves, and that it pushes: a stop of one joint pushes one
LOW = 0.05  # share of the poses, the lowest, in which a surface pushes
LEAST_LEVER = 0.2  # of a joint that it pushes, of the largest
LEAST_SHARE = 0.5  # of the squared error where it acts that a named surface takes away
USUAL = 2.0  # usual errors at which a score has half of its slope


@dataclass(frozen=True, eq=False)
class Touched:
    """Scores where a surface acts.

    Args:
        without, with_it: ½ log(mean e² + s²) summed over the touched joints of each block of time, shape (blocks,); s
            is `USUAL` times a joint's usual error, as blocks that the law hits by chance say little.
        joints: shape (blocks, joints), which ones it moves.
        squares: shape (blocks, 3), Σ e² of all joints by the nominal arm, without and with the surface [rad²].
    """

    without: np.ndarray
    with_it: np.ndarray
    joints: np.ndarray
    squares: np.ndarray

    @property
    def enough(self) -> bool:
        """Whether it acts for long enough, and on more than one joint."""
        return len(self.without) >= LEAST_BLOCKS and int(np.sum(self.joints.any(axis=0))) >= LEAST_JOINTS

    @property
    def gain(self) -> tuple[float, float]:
        """Mean gain of the scores, and that gain over its standard error."""
        return advantage(self.without, self.with_it)

    @property
    def left(self) -> float:
        """Root mean square error with the surface over that without; 1 where it acts nowhere."""
        _, before, after = self.squares.sum(axis=0)
        return float(np.sqrt(after / before)) if before > 0.0 else 1.0

    def helps(self, limits: SelectionLimits) -> bool:
        """Whether errors of motion that was not fitted shrink with it."""
        return self.enough and self.left < np.exp(-limits.gain)

    def is_named(self, limits: SelectionLimits) -> bool:
        """Whether they do so in most blocks, beyond their scatter, and by half."""
        gain, errors = self.gain
        return gain >= limits.gain and errors >= limits.errors and self.left**2 <= 1.0 - LEAST_SHARE


def touched(nominal: list[np.ndarray], over: FreeMotion, surface: np.ndarray, floors: np.ndarray) -> Touched:
    """The blocks of some runs in which a surface moves a joint by more than its floor.

    Args:
        nominal: errors of every joint by the nominal arm.
        over: runs that the surface was not fitted to, as the corrected laws predict them.
        surface: shape (len(SURFACE),).
        floors: shape (joints,), resolution of the errors [rad].
    """
    data, free, held = over.data, over.errors(), over.errors(surface)
    apart = [a - b for a, b in zip(free, held, strict=True)]
    scales = _usual_errors(data, free, apart, floors)
    acts = (_by_joint(data, apart, scales) > 0.5 * np.log(2.0 * scales**2)[:, None]).T
    rows = acts.any(axis=1)
    squares = [np.exp(2.0 * _by_joint(data, e, 1e-3 * floors).T[rows]).sum(axis=1) for e in (nominal, free, held)]
    without, with_it = ((acts * _by_joint(data, e, USUAL * scales).T)[rows].sum(axis=1) for e in (free, held))
    return Touched(without, with_it, acts[rows], np.column_stack(squares))


def pushed_joints(tree: KinematicTree, surface: np.ndarray, poses: np.ndarray) -> int:
    """Number of joints that a surface pushes, those with a lever in the lowest poses: a stop pushes one, and moves all.

    Args:
        tree: the rigid bodies.
        surface: shape (len(SURFACE),).
        poses: shape (n, dof).
    """
    z = heights_of(tree, surface, poses)
    levers = np.sqrt(np.mean(levers_of(tree, surface, poses[z <= np.quantile(z, LOW)]) ** 2, axis=0))
    return int(np.sum(levers > LEAST_LEVER * levers.max()))


def _usual_errors(data: ArmRuns, free: list[np.ndarray], apart: list[np.ndarray], floors: np.ndarray) -> np.ndarray:
    """Median over blocks of the error of each joint where the surface does not act, at least its floor, (joints,)."""
    acts = _by_joint(data, apart, floors) > 0.5 * np.log(2.0 * floors**2)[:, None]
    size = np.exp(_by_joint(data, free, floors))
    usual = [np.median(row[~on]) if not on.all() else np.median(row) for row, on in zip(size, acts, strict=True)]
    return np.maximum(floors, usual)


def together(parts: Sequence[Touched]) -> Touched:
    """All of them."""
    names = ("without", "with_it", "joints", "squares")
    return Touched(*(np.concatenate([getattr(p, n) for p in parts]) for n in names))


def _by_joint(data: ArmRuns, errors: list[np.ndarray], floors: np.ndarray) -> np.ndarray:
    """Scores of every joint in every block, shape (joints, blocks)."""
    return data.scores(errors, floors).reshape(len(errors), -1)
