"""Normal equations of one joint, and the squared errors of the selections that were judged on them already."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from lagnet.diagnosis.regression.bordered import BorderedSystems
from lagnet.diagnosis.regression.compiled import rows_inside
from lagnet.diagnosis.regression.cross_validation import NormalEquations, take_off
from lagnet.diagnosis.regression.library import Library


@dataclass(frozen=True)
class Judged:
    """Squared error on blocks left out of the fit [N² m²], and whether all coefficients lie inside their bounds."""

    error: float
    feasible: bool


@dataclass(frozen=True, eq=False)
class JointSystem:
    """Normal equations of a joint, the residual last; each selection is judged once.

    Args:
        library: the hypotheses.
        joint: index.
        total: shape (K + 1, K + 1), sum of all blocks; the K columns are those of the joint's own hypotheses.
        folds: shape (n_folds, K + 1, K + 1).
        each: gives the blocks, shape (B, K + 1, K + 1), block b of fold b mod n_folds.
        known: what was judged, by selections in increasing order.
        found: what a search found, selections by where it began among it.
        more: squared errors with each hypothesis more, by selections in increasing order.
    """

    library: Library
    joint: int
    total: np.ndarray
    folds: np.ndarray
    each: Callable[[], np.ndarray]
    known: dict[tuple[int, ...], Judged] = field(default_factory=dict)
    found: dict[Hashable, Any] = field(default_factory=dict)
    more: dict[tuple[int, ...], tuple[np.ndarray, np.ndarray]] = field(default_factory=dict)

    @property
    def power(self) -> float:
        """Squared residual of the empty selection [N² m²]."""
        return float(self.total[-1, -1])

    def solved(self, selection: Sequence[int]) -> tuple[float, np.ndarray]:
        """E(S) on blocks left out of the fit [N² m²], and θ of all blocks."""
        return self._bordered.alone(self.columns(selection))

    def judged(self, selection: Sequence[int]) -> Judged:
        """E(S), and whether its coefficients are feasible."""
        key = tuple(sorted(selection))
        if key not in self.known:
            error, theta = self.solved(key)
            lower, upper = self.library.bounds_at(self.joint)
            columns = self.columns(key)
            inside = rows_inside(theta[None], columns, columns[None, :0], lower, upper)
            self.known[key] = Judged(error, bool(inside[0]))
        return self.known[key]

    def with_each(self, selection: Sequence[int]) -> tuple[np.ndarray, np.ndarray]:
        """E(S ∪ {k}) and whether its coefficients are feasible, for every hypothesis k of the joint, shape (m,) each.

        Hypotheses of the selection itself are not feasible beside it.
        """
        key = tuple(sorted(selection))
        if key not in self.more:
            self.more[key] = self._with_each(key)
        return self.more[key]

    def _with_each(self, selection: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray]:
        local = self.library.local[self.joint]
        errors, feasible = np.full(len(local), np.inf), np.zeros(len(local), dtype=bool)
        base = self.columns(selection)
        lower, upper = self.library.bounds_at(self.joint)
        for places, columns in self.library.by_width[self.joint]:
            found = self._bordered.with_additions(base, columns)
            errors[places] = found.errors
            feasible[places] = rows_inside(found.theta, base, columns, lower, upper)
        feasible[[local.index(i) for i in selection]] = False
        return errors, feasible

    @cached_property
    def blocks(self) -> np.ndarray:
        """G_b of each block, shape (B, K + 1, K + 1)."""
        return self.each()

    @cached_property
    def _bordered(self) -> BorderedSystems:
        return BorderedSystems(self.total, self.folds)

    def columns(self, selection: Sequence[int]) -> np.ndarray:
        """Column numbers of a selection, shape (k,)."""
        return self.library.columns_of(self.joint, selection)


def joint_system(equations: NormalEquations, joint: int, taken: dict[int, np.ndarray]) -> JointSystem:
    """The equations of a joint after known contributions of arm-wide hypotheses are subtracted.

    Args:
        equations: of the whole arm; where nothing is subtracted, what was judged on them is shared by all who ask.
        joint: index.
        taken: coefficients of arm-wide hypotheses.
    """
    felt = {i: theta for i, theta in taken.items() if equations.is_felt(joint, i)}
    own = equations.columns(joint, equations.library.local[joint])
    columns = equations.columns(joint, felt)
    theta = np.concatenate([np.zeros(0), *felt.values()])

    def each() -> np.ndarray:
        return take_off(equations.grams.joints[joint], columns, theta, own)

    def made() -> JointSystem:
        total, folds = (take_off(x, columns, theta, own) for x in (equations.total[joint], equations.folds[joint]))
        return JointSystem(equations.library, joint, total, folds, each)

    return made() if felt else equations.remembered(joint, made)
