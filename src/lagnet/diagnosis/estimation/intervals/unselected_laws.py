"""Δp = p̂(beside a further law) − p̂: how far the parameters lean on usual laws of a joint that were not selected.

Every geared joint has friction, a rotor, and an offset of its torque sensor. That one of them has no name says that
these recordings hold too little evidence of it, not that it is absent: what it adds to the torque is then in the
parameters of the laws that were selected, and another recording of the same arm, in which it does have a name, gives
them other values. An interval of a selected model alone is too narrow for that (Leeb and Pötscher 2005, Econometric
Theory 21, 21–59); the shift beside the further law is taken as one more standard error, as in model averaging. Whether
the effect is there at all has been tested by then, on other data and against its rivals: the shift leaves that alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from lagnet.diagnosis.estimation.intervals.misspecification import Influence, Intervals, Linear, as_it_is, by_effect
from lagnet.diagnosis.estimation.refit import tangent_at
from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import NamedEffect

USUAL = ("viscous_friction", "coulomb_friction", "torque_offset", "rotor_inertia", "load_dependent_friction")
NEAREST = 0.9  # of the way to an effect's absence, beyond which the shift widens no interval


def shifts_beside_unselected(
    problem: Problem, effects: Sequence[NamedEffect], sigma: np.ndarray
) -> list[dict[str, float]]:
    """t max_L |Δp_L| by effect and parameter: half-widths that usual laws L without a name add to 95 % intervals.

    Args:
        problem: as it was fitted.
        effects: as they were fitted, all that were fitted together.
        sigma: shape (dof,), the joints' weights in the fit [N m].
    """
    tangent = tangent_at(problem, effects, sigma)
    whole = Influence(problem, tangent, as_it_is)
    shifts = np.zeros(whole.variance.size)
    for columns in unselected_laws(problem, tangent.pieces, effects, sigma):

        def beside(n: int, r: np.ndarray, j: np.ndarray, further: list[np.ndarray] = columns) -> Linear:
            return r, np.concatenate([j, further[n]], axis=2)

        moved = Influence(problem, tangent, beside).blocks - whole.blocks
        shifts = np.maximum(shifts, np.abs(moved.sum(axis=0)))
    return by_effect(effects, whole.quantile * shifts)


def short_of_absence(effect: NamedEffect, intervals: Intervals, shifts: dict[str, float]) -> Intervals:
    """p̂ ± √(h² + shift²), the shift at most so large that the effect's absence stays outside where it was outside."""
    absent = dict(effect_named(effect.effect).absence)
    out = {}
    for name, (low, high) in intervals.items():
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        wide = float(np.hypot(half, shifts.get(name, 0.0)))
        if name in absent:
            wide = max(half, min(wide, NEAREST * abs(middle - absent[name])))
        out[name] = (middle - wide, middle + wide)
    return out


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
