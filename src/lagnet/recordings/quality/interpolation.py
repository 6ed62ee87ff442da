"""How far samples lie from the smooth curve through their neighbours."""

from __future__ import annotations

import numpy as np


def cubic_weights(time: np.ndarray, nodes: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Lagrange weights of four samples for the value at another time, shape (k, 4).

    w_i = Π_{j ≠ i} (t − t_j) / (t_i − t_j).

    Args:
        time: shape (n,), [s].
        nodes: shape (k, 4), rows of the samples.
        at: shape (k,), rows at whose time the value is wanted.
    """
    x, t = time[at], [time[nodes[:, i]] for i in range(4)]
    weights = np.ones((4, len(x)))  # a row for each node: long columns side by side would be read in leaps
    for i in range(4):
        for j in range(4):
            if i != j:
                weights[i] *= (x - t[j]) / (t[i] - t[j])
    return weights.T


def off_neighbours(time: np.ndarray, x: np.ndarray, at: np.ndarray, left_out: int = 0) -> np.ndarray:
    """Samples less the cubic through two neighbours on either side, shape (k, ...).

    Args:
        time: shape (n,), [s], strictly increasing.
        x: shape (n, ...).
        at: shape (k,), rows with two neighbours before and 2 + left_out behind.
        left_out: samples behind that are jumped over, as if they were not there.
    """
    nodes = at[:, None] + np.array([-2, -1, 1 + left_out, 2 + left_out])
    weights = cubic_weights(time, nodes, at)
    return x[at] - np.einsum("ki,ki...->k...", weights, x[nodes])
