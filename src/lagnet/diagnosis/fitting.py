"""Weighted least squares of a selection of hypotheses, from block normal equations."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.grams import FOLDS, Grams
from lagnet.diagnosis.library import Library

RIDGE = 1e-7  # of a column's own power: settles directions that the data leave open at zero
MEMORY = (1.0, 60.0)  # least and most samples that one piece of independent evidence may take


@dataclass(frozen=True, eq=False)
class Workbench:
    """Normal equations summed in the ways that the search needs.

    Args:
        library: the hypotheses.
        grams: the blocks.
        total: for each joint, the sum of all blocks.
        folds: for each joint, the sums of interleaved groups of blocks.
        samples: shape (dof,), samples that count.
    """

    library: Library
    grams: Grams
    total: tuple[np.ndarray, ...]
    folds: tuple[np.ndarray, ...]
    samples: np.ndarray

    def columns(self, joint: int, selection: Iterable[int]) -> np.ndarray:
        """Column numbers of the selected hypotheses that act on a joint."""
        slots = self.library.slots[joint]
        picked = [np.arange(slots[i].start, slots[i].stop) for i in selection if i in slots]
        return np.concatenate(picked) if picked else np.zeros(0, dtype=int)


def make_workbench(library: Library, grams: Grams) -> Workbench:
    """Sums the blocks."""
    joints = range(library.n_dof)
    return Workbench(
        library,
        grams,
        tuple(grams.total(j) for j in joints),
        tuple(grams.folds(j) for j in joints),
        np.maximum(grams.counts.sum(axis=0), 1.0),
    )


def solve(gram: np.ndarray, moment: np.ndarray, ridge: float = RIDGE) -> np.ndarray:
    """Coefficients of normal equations, batched over leading axes."""
    k = gram.shape[-1]
    diagonal = np.diagonal(gram, axis1=-2, axis2=-1)
    scale = 1.0 / np.sqrt(np.maximum(diagonal, 1e-300))
    scaled = gram * scale[..., :, None] * scale[..., None, :] + ridge * np.eye(k)
    return np.linalg.solve(scaled, (moment * scale)[..., None])[..., 0] * scale


def joint_loss(bench_total: np.ndarray, folds: np.ndarray, columns: np.ndarray) -> tuple[float, np.ndarray]:
    """Squared error of a joint on blocks not used for the fit, and the coefficients from all blocks.

    Args:
        bench_total: shape (K + 1, K + 1), with the residual last.
        folds: shape (FOLDS, K + 1, K + 1).
        columns: numbers of the columns in use.
    """
    if not columns.size:
        return float(bench_total[-1, -1]), np.zeros(0)
    across = columns[:, None], columns[None, :]
    inner, moment = folds[:, *across], folds[:, columns, -1]
    grams = np.concatenate([bench_total[across][None] - inner, bench_total[across][None]])
    moments = np.concatenate([bench_total[columns, -1][None] - moment, bench_total[columns, -1][None]])
    solved = solve(grams, moments)  # without each fold in turn, and last with all
    theta = solved[:-1]
    error = folds[:, -1, -1].sum() - 2.0 * np.vdot(theta, moment)
    error += np.vdot(theta, (inner @ theta[..., None])[..., 0])
    return float(error), solved[-1]


def take_off(gram: np.ndarray, columns: np.ndarray, theta: np.ndarray) -> np.ndarray:
    """Normal equations after a known contribution is taken off the residual; batched over leading axes."""
    out = gram.copy()
    shift = gram[..., :, columns] @ theta
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


def fit_selection(bench: Workbench, selection: Sequence[int], sigma: np.ndarray, folds: bool = True) -> Fit:
    """Fits all selected hypotheses at once, joints weighted by 1/σ², and judges each fold by a fit without it."""
    order = tuple(selection)
    widths = [bench.library.widths[i] for i in order]
    starts = np.concatenate([[0], np.cumsum(widths)]).astype(int)
    where = {i: np.arange(starts[n], starts[n + 1]) for n, i in enumerate(order)}
    gram, moment = assemble(bench, order, where, sigma, [t[None] for t in bench.total])
    theta = solve(gram[0], moment[0]) if order else np.zeros(0)
    coefficients = {i: theta[where[i]] for i in order}
    sse = _unseen_error(bench, order, where, sigma) if folds else np.zeros(bench.library.n_dof)
    return Fit(order, coefficients, sse)


def assemble(bench: Workbench, order: Sequence[int], where: dict, sigma: np.ndarray, tables: Sequence[np.ndarray]):
    """Normal equations of all joints together, shapes (B, K, K) and (B, K)."""
    size = sum(bench.library.widths[i] for i in order)
    gram = np.zeros((tables[0].shape[0], size, size))
    moment = np.zeros((tables[0].shape[0], size))
    for joint, table in enumerate(tables):
        own = [i for i in order if i in bench.library.slots[joint]]
        if not own:
            continue
        here, there = bench.columns(joint, own), np.concatenate([where[i] for i in own])
        weight = 1.0 / sigma[joint] ** 2
        gram[:, there[:, None], there[None, :]] += weight * table[:, here[:, None], here[None, :]]
        moment[:, there] += weight * table[:, here, -1]
    return gram, moment


def _unseen_error(bench: Workbench, order: Sequence[int], where: dict, sigma: np.ndarray) -> np.ndarray:
    rest = [t[None] - f for t, f in zip(bench.total, bench.folds, strict=True)]
    error = np.array([f[:, -1, -1].sum() for f in bench.folds])
    if not order:
        return error
    gram, moment = assemble(bench, order, where, sigma, rest)
    theta = solve(gram, moment)
    for joint, fold in enumerate(bench.folds):
        own = [i for i in order if i in bench.library.slots[joint]]
        if own:
            here, there = bench.columns(joint, own), np.concatenate([where[i] for i in own])
            t = theta[:, there]
            error[joint] += np.einsum("fi,fij,fj->", t, fold[:, here[:, None], here[None, :]], t)
            error[joint] -= 2.0 * np.sum(t * fold[:, here, -1])
    return error


def memory_of(bench: Workbench, joint: int, columns: np.ndarray, theta: np.ndarray) -> float:
    """Samples that make one piece of independent evidence: scatter of block scores over that of white residuals.

    Residuals that hang together over time add up within a block, so that scores of blocks scatter more than
    independent samples would let them.
    """
    table = bench.grams.joints[joint]
    if not columns.size:
        return 1.0
    rest = take_off(table, columns, theta)
    power = rest[:, -1, -1].sum() / bench.samples[joint]
    scores = rest[:, columns, -1]
    usual = power * bench.total[joint][columns, columns]
    keep = usual > 0
    ratios = np.sum(scores[:, keep] ** 2, axis=0) / usual[keep]
    return float(np.clip(np.median(ratios), *MEMORY)) if keep.any() else 1.0


__all__ = ["FOLDS", "Fit", "Workbench", "assemble", "fit_selection", "joint_loss", "make_workbench", "memory_of"]
