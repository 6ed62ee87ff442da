"""Weighted least squares of a selection of hypotheses, from block normal equations."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, TypeVar

import numpy as np

from lagnet.diagnosis.regression.block_gram import BlockGrams
from lagnet.diagnosis.regression.compiled import add_block, squared_errors
from lagnet.diagnosis.regression.library import Library
from lagnet.diagnosis.regression.normal_equations import nonnegative_solve
from lagnet.diagnosis.settings import DecisionLimits

T = TypeVar("T")
RIDGE = 1e-7  # of a column's own power: settles directions that the data leave open at zero
MEMORY = (1.0, 60.0)  # least and most samples that one piece of independent evidence may take


@dataclass(frozen=True, eq=False)
class NormalEquations:
    """Normal equations summed in the ways that the search needs.

    Args:
        library: the hypotheses.
        grams: the blocks.
        total: for each joint, the sum of all blocks.
        folds: for each joint, the sums of interleaved groups of blocks.
        samples: shape (dof,), samples that count.
        limits: where the diagnosis decides.
    """

    library: Library
    grams: BlockGrams
    total: tuple[np.ndarray, ...]
    folds: tuple[np.ndarray, ...]
    samples: np.ndarray
    limits: DecisionLimits = field(default_factory=DecisionLimits)
    _known: dict[Any, Any] = field(default_factory=dict, init=False, repr=False)

    def remembered(self, key: Hashable, make: Callable[[], T]) -> T:
        """What `make` gives, made once."""
        if key not in self._known:
            self._known[key] = make()
        return self._known[key]

    @cached_property
    def without_folds(self) -> tuple[np.ndarray, ...]:
        """For each joint, the sums of all blocks but those of each fold, shape (n_folds, K + 1, K + 1)."""
        return tuple(t[None] - f for t, f in zip(self.total, self.folds, strict=True))

    @cached_property
    def penalties(self) -> np.ndarray:
        """Complexity penalty of each hypothesis, shape (n_hypotheses,) [nats]."""
        return np.array([self.limits.penalty(*freedom) for freedom in self.library.freedom])

    def is_felt(self, joint: int, index: int) -> bool:
        """Whether a hypothesis has any torque at a joint: a link loads no joint behind it."""
        columns = self.columns(joint, [index])
        return bool(np.any(self.total[joint][columns, columns] > 0))

    def columns(self, joint: int, selection: Iterable[int]) -> np.ndarray:
        """Column numbers of the selected hypotheses that act on a joint."""
        return self.library.columns_of(joint, selection)


def sum_normal_equations(library: Library, grams: BlockGrams, limits: DecisionLimits | None = None) -> NormalEquations:
    """Sums the blocks."""
    joints = range(library.n_dof)
    return NormalEquations(
        library,
        grams,
        tuple(grams.total(j) for j in joints),
        tuple(grams.folds(j) for j in joints),
        np.maximum(grams.counts.sum(axis=0), 1.0),
        limits or DecisionLimits(),
    )


def take_off(gram: np.ndarray, columns: np.ndarray, theta: np.ndarray, kept: np.ndarray | None = None) -> np.ndarray:
    """Normal equations after a known contribution is taken off the residual; batched over leading axes.

    Args:
        gram: shape (..., K + 1, K + 1), the residual last.
        columns, theta: shape (k,), what is known.
        kept: columns of the result before the residual; None: all.
    """
    rows = np.arange(gram.shape[-1]) if kept is None else np.append(kept, gram.shape[-1] - 1)
    out = gram[..., rows[:, None], rows]
    shift = gram[..., rows[:, None], columns] @ theta
    out[..., :, -1] -= shift
    out[..., -1, :] -= shift
    out[..., -1, -1] += np.einsum("...i,i->...", gram[..., columns, :][..., :, columns] @ theta, theta)
    return out


@dataclass(frozen=True, eq=False)
class Fit:
    """Coefficients of a selection.

    Args:
        selection: indices of the hypotheses, in order.
        coefficients: for each of them its coefficients.
        sse: shape (dof,), squared error on unseen blocks, summed.
    """

    selection: tuple[int, ...]
    coefficients: dict[int, np.ndarray]
    sse: np.ndarray


def fit_selection(equations: NormalEquations, selection: Sequence[int], sigma: np.ndarray, folds: bool = True) -> Fit:
    """Fits all selected hypotheses at once, joints weighted by 1/σ², and judges each fold by a fit without it."""
    order = tuple(selection)
    where = _places(equations, order)
    gram, moment = assemble(equations, order, where, sigma, [t[None] for t in equations.total])
    theta = _solved(equations, order, gram[0], moment[0]) if order else np.zeros(0)
    coefficients = {i: theta[where[i]] for i in order}
    sse = _unseen_error(equations, order, where, sigma) if folds else np.zeros(equations.library.n_dof)
    return Fit(order, coefficients, sse)


def _places(equations: NormalEquations, order: Sequence[int]) -> dict[int, np.ndarray]:
    """Rows of the coefficients of each hypothesis where all stand one after the other."""
    starts = np.concatenate([[0], np.cumsum([equations.library.widths[i] for i in order])]).astype(int)
    return {i: np.arange(starts[n], starts[n + 1]) for n, i in enumerate(order)}


def assemble(
    equations: NormalEquations, order: Sequence[int], where: dict, sigma: np.ndarray, tables: Sequence[np.ndarray]
):
    """Normal equations of all joints together, shapes (B, K, K) and (B, K)."""
    size = sum(equations.library.widths[i] for i in order)
    gram = np.zeros((tables[0].shape[0], size, size))
    moment = np.zeros((tables[0].shape[0], size))
    for joint, table in enumerate(tables):
        own = [i for i in order if i in equations.library.slots[joint]]
        if not own:
            continue
        here, there = equations.columns(joint, own), np.concatenate([where[i] for i in own])
        weight = 1.0 / sigma[joint] ** 2
        add_block(gram, moment, table, here, there, weight)
    return gram, moment


def _unseen_error(equations: NormalEquations, order: Sequence[int], where: dict, sigma: np.ndarray) -> np.ndarray:
    error = np.array([f[:, -1, -1].sum() for f in equations.folds])
    if not order:
        return error
    theta = _theta_without_folds(equations, order, where, sigma)
    for joint, fold in enumerate(equations.folds):
        own = [i for i in order if i in equations.library.slots[joint]]
        if own:
            here, there = equations.columns(joint, own), np.concatenate([where[i] for i in own])
            error[joint] = squared_errors(fold, here, theta, there)
    return error


def _theta_without_folds(
    equations: NormalEquations, order: Sequence[int], where: dict, sigma: np.ndarray
) -> np.ndarray:
    """Coefficients of the fit to all folds but one, shape (n_folds, K)."""
    gram, moment = assemble(equations, order, where, sigma, equations.without_folds)
    return _solved(equations, order, gram, moment)


def _solved(equations: NormalEquations, order: Sequence[int], gram: np.ndarray, moment: np.ndarray) -> np.ndarray:
    """Coefficients of a selection, batched; none below zero where a law says that it has no such."""
    library = equations.library
    laws = [library.hypotheses[i].law for i in order]
    signed = np.repeat([law.nonnegative for law in laws], [library.widths[i] for i in order])
    return nonnegative_solve(gram, moment, RIDGE, signed)


def unseen_block_errors(equations: NormalEquations, selection: Sequence[int], sigma: np.ndarray) -> np.ndarray:
    """Squared error of each joint in each block, of the fit to all folds but the block's, shape (dof, B) [N² m²]."""
    order = tuple(selection)
    where = _places(equations, order)
    theta = _theta_without_folds(equations, order, where, sigma) if order else np.zeros((1, 0))
    out = []
    for joint, blocks in enumerate(equations.grams.joints):
        own = [i for i in order if i in equations.library.slots[joint]]
        rows = np.concatenate([np.zeros(0, dtype=int), *(where[i] for i in own)])
        out.append(errors_in_blocks(blocks, equations.columns(joint, own), theta[:, rows]))
    return np.array(out)


def errors_in_blocks(blocks: np.ndarray, columns: np.ndarray, theta: np.ndarray) -> np.ndarray:
    """‖r − X θ‖² of each block, shape (B,) [N² m²].

    Args:
        blocks: shape (B, K + 1, K + 1), with the residual last.
        columns: shape (k,), of X.
        theta: shape (n_folds, k); that of block b is b mod n_folds.
    """
    own = np.append(columns, blocks.shape[-1] - 1)
    weights = np.column_stack([-theta, np.ones(len(theta))])[np.arange(len(blocks)) % len(theta)]
    return np.maximum(np.einsum("bi,bij,bj->b", weights, blocks[:, own[:, None], own], weights), 0.0)


def statistical_inefficiency(equations: NormalEquations, joint: int, columns: np.ndarray, theta: np.ndarray) -> float:
    """Samples that make one piece of independent evidence: scatter of block scores over that of white residuals.

    Residuals that hang together over time add up within a block, so that scores of blocks scatter more than
    independent samples would let them.
    """
    table = equations.grams.joints[joint]
    if not columns.size:
        return 1.0
    rest = take_off(table, columns, theta, columns)
    power = rest[:, -1, -1].sum() / equations.samples[joint]
    scores = rest[:, :-1, -1]
    usual = power * equations.total[joint][columns, columns]
    keep = usual > 0
    ratios = np.sum(scores[:, keep] ** 2, axis=0) / usual[keep]
    return float(np.clip(np.median(ratios), *MEMORY)) if keep.any() else 1.0
