"""Cross-validation of the identified layer over contiguous blocks of the fitted motion."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from lagnet.diagnosis.identified.design import Design
from lagnet.diagnosis.identified.evidence import Ridge, Sums, fit_ridge, sums_of

FOLDS = 6
GUARD = 3  # samples left out on both sides of a block: for so long the filter remembers
TEMPERS = (3.0, 10.0, 20.0, 40.0)  # samples that may count as one
TIED = 0.5  # of a joint's unseen error without a tie that one must leave less than
IDLE = 0.98  # of what the named model leaves: a joint whose unseen error stays above needs no terms
FIRST, STEPS = 25, 5  # of the evidence's fixed point, from the start and from a fit nearby


@dataclass(frozen=True, eq=False)
class Fold:
    """Normal equations of all joints in one block, to judge by, and outside it, to fit."""

    judged: tuple[Sums, ...]
    fitted: tuple[Sums, ...]


def block_folds(design: Design, n_folds: int = FOLDS) -> tuple[Fold, ...]:
    """Contiguous blocks of about equal length, with a guard of samples around each that are neither fitted nor judged.

    Args:
        design: the equations, in the order of time.
        n_folds: number of blocks.
    """
    n, whole, out = design.joints[0].target.size, sums_of(design), []
    edges = np.linspace(0, n, n_folds + 1).round().astype(int)
    for first, last in pairwise(edges.tolist()):
        near = sums_of(design, slice(max(0, first - GUARD), last + GUARD))
        fitted = tuple(w - s for w, s in zip(whole, near, strict=True))
        out.append(Fold(sums_of(design, slice(first, last)), fitted))
    return tuple(out)


@dataclass(frozen=True, eq=False)
class Choice:
    """A fit to all rows, with what it was chosen by.

    Args:
        ridge: the fit.
        temper: samples that count as one.
        barred: indices of groups that are left out.
        unseen: shape (dof,), squared error on blocks that were not fitted, over the power of the target.
    """

    ridge: Ridge
    temper: float
    barred: frozenset[int]
    unseen: np.ndarray

    @property
    def score(self) -> float:
        """Sum of the logarithms of the joints' unseen errors: joints weigh alike."""
        return float(np.sum(np.log(np.maximum(self.unseen, 1e-300))))


def choose(design: Design, tempers: Sequence[float] = TEMPERS) -> Choice | None:
    """The temper, the ties and the joints with terms that predict unseen blocks best; None where nothing does."""
    folds, groups = block_folds(design), design.groups
    barred = frozenset(i for i, g in enumerate(groups) if g.pair is not None)
    best = min(_tempered(design, folds, tempers, barred), key=lambda c: c.score)
    needed = frozenset().union(*(_tie(design, folds, best, pair) for pair in {g.pair for g in groups if g.pair}))
    idle = frozenset(i for i, g in enumerate(groups) if g.joint is not None and best.unseen[g.joint] > IDLE)
    if needed or idle:
        best = min(_tempered(design, folds, tempers, (barred - needed) | idle), key=lambda c: c.score)
    return best if np.any(best.unseen <= IDLE) else None


def _tie(design: Design, folds: Sequence[Fold], best: Choice, pair: tuple[int, int]) -> frozenset[int]:
    """The groups that tie a pair of joints, where one of them is predicted far better with them; else none."""
    own = frozenset(i for i, g in enumerate(design.groups) if g.pair == pair)
    tied = _judged(design, folds, best.temper, best.barred - own)
    return own if np.any((tied.unseen < TIED * best.unseen)[list(pair)]) else frozenset()


def _tempered(
    design: Design, folds: Sequence[Fold], tempers: Sequence[float], barred: frozenset[int]
) -> Iterator[Choice]:
    start = None
    for temper in tempers:
        choice = _judged(design, folds, temper, barred, start)
        start = choice.ridge
        yield choice


def _judged(
    design: Design, folds: Sequence[Fold], temper: float, barred: frozenset[int], start: Ridge | None = None
) -> Choice:
    """A fit to all rows, and the error of fits with its widths and noise to blocks that they have not seen."""
    whole = sums_of(design)
    ridge = fit_ridge(design, whole, temper, start, FIRST if start is None else STEPS, barred)
    lost = np.zeros(len(design.joints))
    for fold in folds:
        part = fit_ridge(design, fold.fitted, temper, ridge, STEPS, barred)
        lost += [s.error(part.x[j.unknowns]) for s, j in zip(fold.judged, design.joints, strict=True)]
    return Choice(ridge, temper, barred, lost / np.array([max(s.power, 1e-300) for s in whole]))
