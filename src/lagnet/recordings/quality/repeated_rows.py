"""Rows of a recording that are copies of the one before."""

from __future__ import annotations

import numpy as np

CHANNELS = 3  # that must stand still together to the last digit
LIVELY = 0.9  # of the steps asked, in which such channels change: elsewhere, standing still says something


def repeated_rows(values: np.ndarray, asked: np.ndarray) -> np.ndarray:
    """Rows that repeat the one before in every lively channel, to the last digit, shape (n,).

    Args:
        values: shape (n, k), all channels.
        asked: shape (n − 1,), the steps by which a channel is called lively.
    """
    changes = np.diff(values, axis=0) != 0
    lively = changes[asked].mean(axis=0) > LIVELY if np.any(asked) else np.zeros(values.shape[1], dtype=bool)
    if lively.sum() < CHANNELS:
        return np.zeros(len(values), dtype=bool)
    return np.concatenate([[False], ~changes[:, lively].any(axis=1)])
