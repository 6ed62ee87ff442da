"""Normal equations of one joint, and the squared errors of the selections that were judged on them already."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from lagnet.diagnosis.regression.bordered import BorderedSystems
from lagnet.diagnosis.regression.cross_validation import NormalEquations, joint_loss, take_off
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
        total: shape (K + 1, K + 1), sum of all blocks.
        folds: shape (n_folds, K + 1, K + 1).
        known: what was judged, by selections in increasing order.
        found: selections that a search found, by where it began.
    """

    library: Library
    joint: int
    total: np.ndarray
    folds: np.ndarray
    known: dict[tuple[int, ...], Judged] = field(default_factory=dict)
    found: dict[Hashable, tuple[int, ...]] = field(default_factory=dict)

    @property
    def power(self) -> float:
        """Squared residual of the empty selection [N² m²]."""
        return float(self.total[-1, -1])

    def solved(self, selection: Sequence[int]) -> tuple[float, np.ndarray]:
        """E(S) on blocks left out of the fit [N² m²], and θ of all blocks."""
        return joint_loss(self.total, self.folds, self._columns(selection))

    def judged(self, selection: Sequence[int]) -> Judged:
        """E(S), and whether its coefficients are feasible."""
        key = tuple(sorted(selection))
        if key not in self.known:
            error, theta = self.solved(key)
            lower, upper = self.library.bounds_at(self.joint)
            columns = self._columns(key)
            inside = np.all((theta >= lower[columns]) & (theta <= upper[columns]))
            self.known[key] = Judged(error, bool(inside))
        return self.known[key]

    def judge_additions(self, selection: Sequence[int], added: Iterable[int]) -> None:
        """Judges a selection with each of several hypotheses more, at once."""
        by_width: dict[int, list[int]] = {}
        for i in added:
            if tuple(sorted((*selection, i))) not in self.known:
                by_width.setdefault(self.library.widths[i], []).append(i)
        for own in by_width.values():
            if len(own) > 1:  # one alone is judged when it is asked for
                self._judge_at_once(tuple(selection), own)

    def _judge_at_once(self, selection: tuple[int, ...], added: Sequence[int]) -> None:
        base, columns = self._columns(selection), np.stack([self._columns((i,)) for i in added])
        lower, upper = self.library.bounds_at(self.joint)
        found = self._bordered.with_additions(base, columns)
        inside = np.all((found.base >= lower[base]) & (found.base <= upper[base]), axis=1)
        inside &= np.all((found.added >= lower[columns]) & (found.added <= upper[columns]), axis=1)
        for i, error, feasible in zip(added, found.errors.tolist(), inside.tolist(), strict=True):
            self.known[tuple(sorted((*selection, i)))] = Judged(error, feasible)

    @cached_property
    def _bordered(self) -> BorderedSystems:
        return BorderedSystems(self.total, self.folds)

    def _columns(self, selection: Sequence[int]) -> np.ndarray:
        slots = self.library.slots[self.joint]
        picked = [np.arange(slots[i].start, slots[i].stop) for i in selection]
        return np.concatenate(picked) if picked else np.zeros(0, dtype=int)


def joint_system(equations: NormalEquations, joint: int, taken: dict[int, np.ndarray]) -> JointSystem:
    """The equations of a joint after known contributions of arm-wide hypotheses are subtracted.

    Args:
        equations: of the whole arm; where nothing is subtracted, what was judged on them is shared by all who ask.
        joint: index.
        taken: coefficients of arm-wide hypotheses.
    """
    felt = {i: theta for i, theta in taken.items() if equations.is_felt(joint, i)}
    if not felt:
        return equations.remembered(
            joint, lambda: JointSystem(equations.library, joint, equations.total[joint], equations.folds[joint])
        )
    total, folds = equations.total[joint], equations.folds[joint]
    for index, theta in felt.items():
        columns = equations.columns(joint, [index])
        total, folds = take_off(total, columns, theta), take_off(folds, columns, theta)
    return JointSystem(equations.library, joint, total, folds)
