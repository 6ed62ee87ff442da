"""Where a search for a surface starts: points of the last bodies, heights just above the lowest measured pose."""

from __future__ import annotations

from itertools import product

import numpy as np

from lagnet.diagnosis.motion.arm.rollouts import pieces_of
from lagnet.diagnosis.motion.problem import MotionProblem, Run
from lagnet.rigid_body.kinematic_tree import KinematicTree
from lagnet.rollout.surface import heights_of
from lagnet.servos.parameters import KP

OUTWARDS = (1.0, 2.0)  # of a body's centre of mass, from its joint
RISES = (0.0, 0.025, 0.05)  # of the arm's reach, above the lowest measured point: a surface gives way
HARDER = (3.0, 30.0, 300.0)  # than the servos, whose stiffness at full reach is kp over its square
RUBS = 0.2  # sliding friction
PIECE = 5.0  # [s] of a rollout
SAMPLES = 5000  # that a fit rolls out


def starts_of_surface(problem: MotionProblem, fitted: int, laws: np.ndarray) -> list[np.ndarray]:
    """Surfaces to start from, each of shape (len(SURFACE),).

    Args:
        problem: all recordings, the first `fitted` of them fitted.
        fitted: number of them.
        laws: shape (dof, len(LAW)).
    """
    tree, q = problem.tree, fitted_poses(problem, fitted)
    reach = reach_of(tree)
    soft = float(np.median(laws[:, KP])) / reach**2
    out = []
    for body, far in product(last_bodies(tree), OUTWARDS):
        surface = np.array([body, *(far * _centre(tree, body)), 0.0, 0.0, 0.0])
        lowest = float(heights_of(tree, surface, q).min())
        for rise, harder in product(RISES, HARDER):
            out.append(np.array([*surface[:4], lowest + rise * reach, harder * soft, RUBS]))
    return out


def reach_of(tree: KinematicTree) -> float:
    """Length of the arm [m]: from joint to joint, and to the last body's centre."""
    return float(np.linalg.norm(tree.translations, axis=1).sum() + np.linalg.norm(_centre(tree, len(tree.bodies) - 1)))


def last_bodies(tree: KinematicTree) -> list[int]:
    """Bodies behind which no joint is, and those before them."""
    ends = [i for i in range(len(tree.parents)) if i not in tree.parents]
    return sorted({*ends, *(int(tree.parents[i]) for i in ends if tree.parents[i] >= 0)})


def fitted_poses(problem: MotionProblem, fitted: int) -> np.ndarray:
    """Measured positions that may be fitted, shape (n, dof)."""
    q = np.column_stack([s.q for s in problem.series])
    return np.concatenate([q[r.first : r.last + 1] for r in problem.runs if r.recording < fitted])


def lowest_runs(problem: MotionProblem, fitted: int) -> tuple[Run, ...]:
    """Pieces of what may be fitted in which the last body comes lowest, `SAMPLES` of them.

    Every recording gives its lowest first: where an arm came low and touched nothing says as much as where it touched.
    """
    tree, pieces = problem.tree, []
    last = last_bodies(tree)[-1]
    z = heights_of(
        tree, np.array([last, *_centre(tree, last), 0.0, 0.0, 0.0]), np.column_stack([s.q for s in problem.series])
    )
    for recording in range(fitted):
        own = pieces_of(problem, [run for run in problem.runs if run.recording == recording], PIECE)
        own.sort(key=lambda run: float(z[run.first : run.last + 1].min()))
        pieces += [(turn, float(z[run.first : run.last + 1].min()), run) for turn, run in enumerate(own)]
    chosen = [run for _, _, run in sorted(pieces, key=lambda p: p[:2])]
    sizes = np.cumsum([run.last - run.first + 1 for run in chosen])
    return tuple(sorted(chosen[: max(1, int(np.sum(sizes <= SAMPLES)))], key=lambda run: run.first))


def _centre(tree: KinematicTree, body: int) -> np.ndarray:
    mass = tree.bodies[body, 0]
    return tree.bodies[body, 1:4] / mass if mass > 0.0 else np.zeros(3)
