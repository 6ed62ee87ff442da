"""Least squares over columns of very different size, such as masses beside second moments."""

from __future__ import annotations

import numpy as np


def scaled_weights(columns: np.ndarray, wanted: np.ndarray, rank: float) -> np.ndarray:
    """Weights (k,) of columns (n, k) that come nearest to wanted (n,); a column of zeros gets none.

    Args:
        rank: of the largest singular value, columns scaled to one, below which a direction is left at zero.
    """
    if not columns.shape[1]:
        return np.zeros(0)
    size = np.linalg.norm(columns, axis=0)
    size = np.where(size > 0, size, 1.0)
    return np.linalg.lstsq(columns / size, wanted, rcond=rank)[0] / size
