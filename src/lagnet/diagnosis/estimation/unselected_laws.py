"""Δp = p̂(beside a further law) − p̂: how far the parameters lean on usual laws of a joint that were not selected.

Every geared joint has friction, a rotor, and an offset of its torque sensor. That one of them has no name says that
these recordings hold too little evidence of it, not that it is absent: what it adds to the torque is then in the
parameters of the laws that were selected, and another recording of the same arm, in which it does have a name, gives
them other values. An interval of a selected model alone is too narrow for that (Leeb and Pötscher 2005, Econometric
Theory 21, 21–59); the shift beside the further law is taken as one more standard error, as in model averaging.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import NamedEffect

USUAL = ("viscous_friction", "coulomb_friction", "torque_offset", "rotor_inertia", "load_dependent_friction")


def unselected_laws(
    problem: Problem, pieces: Sequence[Segment], effects: Sequence[NamedEffect], sigma: np.ndarray
) -> Iterator[list[np.ndarray]]:
    """For each usual law its columns ∂e/∂p at all joints that lack it, over σ: (len(keep), dof, n_joints) a piece.

    Args:
        problem: as it was fitted.
        pieces: of the fit.
        effects: as they were fitted.
        sigma: shape (dof,), the joints' weights in the fit [N m].
    """
    for name in USUAL:
        joints = [j for j in range(problem.n_dof) if not _is_known(name, [e for e in effects if e.joint == j])]
        joints = [j for j in joints if any(e.joint in (j, None) or _reaches(e) for e in effects)]
        if joints:
            yield [_columns(problem, piece, name, joints, sigma) for piece in pieces]


def _is_known(name: str, own: Sequence[NamedEffect]) -> bool:
    """Whether a joint's effects hold a law, itself or within another."""
    law = effect_named(name)
    return any({name, *law.contains} & {e.effect, *effect_named(e.effect).contains} for e in own)


def _reaches(effect: NamedEffect) -> bool:
    return effect_named(effect.effect).reaches_all


def _columns(problem: Problem, piece: Segment, name: str, joints: Sequence[int], sigma: np.ndarray) -> np.ndarray:
    motion, law = piece.motion(problem), effect_named(name)
    moved = problem.reduce(piece, np.column_stack([law.columns(motion, j, {})[:, 0] for j in joints]))
    out = np.zeros((piece.keep.size, problem.n_dof, len(joints)))
    out[:, joints, range(len(joints))] = moved * piece.counts[:, joints] / sigma[joints]
    return out
