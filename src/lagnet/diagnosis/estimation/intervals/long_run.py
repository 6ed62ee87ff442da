"""h² = max_L t_L² Σ_B (Σ_{b∈B} Δp_b)²: squared half-width of intervals where residuals stay alike over many blocks.

Δp_b is what a block of time adds to the parameters, B are runs of L neighbouring blocks of one segment. Where blocks
are independent, every L gives the same up to chance; where what is left over lasts longer than a block, as the warming
up of a joint does, longer runs give more. Longer runs are fewer, which Student's quantile t_L accounts for. The method
is the blocking of Flyvbjerg and Petersen 1989 (J. Chem. Phys. 91, 461–466).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.stats import t as student

LENGTHS = (2, 4, 8)  # of runs, in blocks
FEWEST = 4  # runs from which a variance is taken


def long_run_excess(blocks: np.ndarray, counts: Sequence[int]) -> np.ndarray:
    """By how much h² is larger than that of single blocks, shape (n_parameters,), never negative.

    Args:
        blocks: shape (n_blocks, n_parameters), what each block adds to the parameters.
        counts: blocks of each segment, in order.
    """
    single = _squared_half_width(blocks)
    widest = single
    for length in LENGTHS:
        runs = _runs(blocks, counts, length)
        if len(runs) >= FEWEST:
            widest = np.maximum(widest, _squared_half_width(runs))
    return widest - single


def _runs(blocks: np.ndarray, counts: Sequence[int], length: int) -> np.ndarray:
    """Sums over neighbours, in runs of nearly the same length that end with their segment."""
    sums = []
    for part in np.split(blocks, np.cumsum(counts)[:-1]):
        for run in np.array_split(part, max(1, round(len(part) / length))):
            sums.append(run.sum(axis=0))
    return np.array(sums)


def _squared_half_width(blocks: np.ndarray) -> np.ndarray:
    quantile = float(student.ppf(0.975, max(1, len(blocks) - 1)))
    return quantile**2 * np.sum(blocks**2, axis=0)
