"""Odds that one selection predicts blocks of motion better than another, from the scatter between blocks.

With D = Σ_j n_j / (2 g_j) ln(E'_j / E_j) the difference of log evidence and u_b the influence of block b on it,

> z = D / √(B / (B − 1) Σ_b u_b²),  u_b = Σ_j n_j / (2 g_j) (E'_jb / E'_j − E_jb / E_j)

is the test of Vuong (Econometrica 57, 1989) for two inexact models. The odds are those of a Student variable of
B − 1 degrees of freedom to lie below z, and at most exp D: where something structured is always left, a sum over
many samples is surer than the recordings are.

Of two selections the simpler one has the smaller penalty P on complexity. Where the blocks prefer it, P' − P adds to
the odds. Where they prefer the other, that one must first make good its penalty, as in Vuong's corrected test: then
D + P' − P is bounded in the place of D.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.stats import t as student

from lagnet.diagnosis.regression.cross_validation import RIDGE, errors_in_blocks
from lagnet.diagnosis.regression.normal_equations import ridge_solve

GREATEST = 99.0  # powers of ten that are told
LN10 = float(np.log(10.0))


def held_out_errors(blocks: np.ndarray, folds: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Squared error in each block of the fit to all folds but its own, shape (B,) [N² m²].

    Args:
        blocks: shape (B, K + 1, K + 1), Gram matrices with the residual last; block b is of fold b mod n_folds.
        folds: shape (n_folds, K + 1, K + 1), their sums by fold.
        columns: shape (k,), of the selection.
    """
    theta = np.zeros((len(folds), columns.size))
    if columns.size:
        rest = (folds.sum(axis=0) - folds)[:, :, np.append(columns, -1)][:, columns]
        theta = ridge_solve(rest[..., :-1], rest[..., -1], RIDGE)
    return errors_in_blocks(blocks, columns, theta)


def log10_odds(
    pieces: ArrayLike, here: np.ndarray, there: np.ndarray, floors: ArrayLike, simpler: float = 0.0
) -> float:
    """log10 odds of the selection with errors `here` over the one with errors `there`.

    Args:
        pieces: n_j / g_j, independent pieces of evidence of each joint.
        here, there: shape (J, B), squared errors by joint and block [N² m²].
        floors: least squared error of each joint that counts [N² m²].
        simpler: P' − P, penalty of the one with errors `there` less that of the selection.
    """
    weight = 0.5 * np.asarray(pieces)
    sums = [np.maximum(e.sum(axis=1), np.maximum(floors, 1e-300)) for e in (here, there)]
    here_lost, there_lost = (bool(np.isinf(s).any()) for s in sums)  # one that a fold leaves undetermined
    if here_lost or there_lost:
        return GREATEST * (there_lost - here_lost)
    gain = float(np.sum(weight * np.log(sums[1] / sums[0])))
    influence = weight @ (there / sums[1][:, None] - here / sums[0][:, None])
    felt = int(np.sum(np.any(here + there > 0.0, axis=0)))
    if felt < 2 or gain == 0.0:
        return simpler / LN10
    spread = float(np.sqrt(felt / (felt - 1) * np.sum(influence**2)))
    if gain * simpler >= 0.0:
        return _bounded(gain, spread, felt) + simpler / LN10
    left = gain + simpler
    return _bounded(left, spread, felt) if left * gain > 0.0 else left / LN10


def _bounded(gain: float, spread: float, felt: int) -> float:
    """log10 odds of a gain of evidence [nats] with a standard deviation, told by so many blocks."""
    z = abs(gain) / max(spread, 1e-12 * abs(gain))
    told = (student.logcdf(z, felt - 1) - student.logsf(z, felt - 1)) / LN10
    return float(np.copysign(min(abs(gain) / LN10, told, GREATEST), gain))
