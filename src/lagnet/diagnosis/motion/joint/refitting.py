"""argmin over the free parameters of a law with some effects: refits of one joint, from several starts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.motion.joint.block_scores import block_length, block_scores
from lagnet.diagnosis.motion.joint.fitting import Fitted, fit_law, free_coordinates
from lagnet.diagnosis.motion.joint.joint_case import JointCase, sizes_of
from lagnet.servos.catalogue import servo_effect
from lagnet.servos.parameters import KP, NAMES

FULL = 12  # iterations
FOLD = 4  # iterations in another fold, from the law of the first


@dataclass(frozen=True, eq=False)
class Selection:
    """Effects of one joint and the law fitted with them.

    Args:
        effects: names of the catalogue.
        fitted: the law.
        blocks: shape (n_blocks,), scores on validation windows, those of every fold by the law fitted to the others.
    """

    effects: tuple[str, ...]
    fitted: Fitted
    blocks: np.ndarray

    @property
    def law(self) -> np.ndarray:
        return self.fitted.law


def groups_of(case: JointCase, effects: Sequence[str]) -> list[tuple[str, ...]]:
    """Law parameters that are free with these effects, each group with one value."""
    groups = list(case.base)
    for name in effects:
        law = servo_effect(name)
        free = (group for group in law.frees if group[0] not in law.chosen)
        groups += [*free, *((extra,) for extra in law.with_it)]
    return disjoint(groups)


def disjoint(groups: Sequence[tuple[str, ...]]) -> list[tuple[str, ...]]:
    """Groups of law parameters less those that an earlier one holds, single parameters before shared ones."""
    taken: set[str] = set()
    out = []
    for group in sorted(dict.fromkeys(groups), key=len):
        left = tuple(p for p in group if p not in taken)
        if left:
            out.append(left)
            taken |= set(left)
    return out


def refit(
    case: JointCase,
    effects: Sequence[str],
    law: np.ndarray,
    scale: float,
    iterations: int = FULL,
    patient: bool = False,
) -> Selection:
    """The law with these effects fitted from a start, and its scores on validation windows.

    Args:
        case: the joint.
        effects: names of the catalogue.
        law: the start, shape (len(LAW),).
        scale: robust scale of the residual [rad].
        iterations: of Gauss–Newton.
        patient: try coarser differences where the cost does not fall.
    """
    coordinates = free_coordinates(groups_of(case, effects), law, sizes_of(case.scales))
    fitted = fit_law(case.fit, law, coordinates, scale=scale, iterations=iterations, patient=patient)
    length = block_length(case.validation, *(validation for _, validation in case.folds))
    blocks = [block_scores(case.validation, fitted.law, case.floor, length)]
    for fit, validation in case.folds:
        other = fit_law(fit, fitted.law, coordinates, scale=scale, iterations=FOLD)
        blocks.append(block_scores(validation, other.law, case.floor, length))
    return Selection(tuple(effects), fitted, np.concatenate(blocks))


def starts_with(case: JointCase, selected: Selection, name: str) -> list[np.ndarray]:
    """Laws from which a fit with one more effect starts, each of shape (len(LAW),)."""
    effect = servo_effect(name)
    kp, out = float(selected.law[KP]), []
    for start in effect.starts(replace(case.scales, kp=kp, torque=case.scales.torque * kp / case.scales.kp)):
        out.append(effect.apply(selected.law, dict(zip([p.name for p in effect.parameters], start, strict=True))))
    return out


def without(case: JointCase, selected: Selection, name: str, scale: float) -> Selection:
    """The selection without one effect: its parameters nominal, the others refitted."""
    kept = tuple(e for e in selected.effects if e != name)
    law, free = selected.law.copy(), {p for g in groups_of(case, kept) for p in g}
    for group in groups_of(case, (name,)):
        for parameter in set(group) - free:
            law[NAMES.index(parameter)] = case.law[NAMES.index(parameter)]
    return refit(case, kept, law, scale)
