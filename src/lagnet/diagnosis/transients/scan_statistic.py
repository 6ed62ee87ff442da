"""½ mᵀG⁻¹m with G, m summed over [t₀, t₁]: log likelihood gain of a few columns, each interval by one small solve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

RIDGE = 1e-6  # of a column's power: sets directions that an interval does not determine to zero
EDGE_ROUNDS = 8
CHUNK = 10_000  # intervals that are solved for at once, which bounds the memory


@dataclass(frozen=True, eq=False)
class Running:
    """Normal equations summed from the first sample to each, so that an interval is a difference.

    Args:
        gram: shape (n + 1, k, k); moment: shape (n + 1, k); power: shape (n + 1,).
    """

    gram: np.ndarray
    moment: np.ndarray
    power: np.ndarray

    def gains(self, start: np.ndarray, stop: np.ndarray) -> np.ndarray:
        """Log likelihood [nats] that the columns gain on the samples start to stop - 1, shape (n_intervals,)."""
        parts = range(0, max(1, len(start)), CHUNK)
        return np.concatenate([self._gains(start[i : i + CHUNK], stop[i : i + CHUNK]) for i in parts])

    def _gains(self, start: np.ndarray, stop: np.ndarray) -> np.ndarray:
        gram, moment = self.gram[stop] - self.gram[start], self.moment[stop] - self.moment[start]
        diagonal = np.maximum(np.diagonal(gram, axis1=1, axis2=2), 0.0)
        least = RIDGE * self.gram[-1].diagonal() / max(1, len(self.power))  # a column that is nothing here stays out
        scale = np.where(diagonal > least, 1.0 / np.sqrt(np.maximum(diagonal, 1e-300)), 0.0)
        scaled = gram * scale[:, :, None] * scale[:, None, :] + RIDGE * np.eye(gram.shape[-1])
        target = moment * scale
        gained = 0.5 * np.einsum("nk,nk->n", target, np.linalg.solve(scaled, target[..., None])[..., 0])
        return np.minimum(gained, 0.5 * (self.power[stop] - self.power[start]))

    def best_edges(self, start: int, stop: int, shortest: int) -> tuple[int, int]:
        """The interval near a given one on which the columns gain most: one edge after the other, until both stay."""
        n = len(self.power) - 1
        for _ in range(EDGE_ROUNDS):
            reach = max(shortest, stop - start)
            starts = np.arange(max(0, start - reach), stop - shortest + 1)
            first = int(starts[np.argmax(self.gains(starts, np.full_like(starts, stop)))])
            stops = np.arange(first + shortest, min(n, stop + reach) + 1)
            last = int(stops[np.argmax(self.gains(np.full_like(stops, first), stops))])
            if (first, last) == (start, stop):
                break
            start, stop = first, last
        return start, stop


def run_up(columns: np.ndarray, residual: np.ndarray, weight: np.ndarray) -> Running:
    """Sums over the samples of one recording.

    Args:
        columns: shape (n, dof, k).
        residual: shape (n, dof).
        weight: shape (n, dof), one over the variance of each entry, 0 where it does not count.
    """
    weighted = columns * weight[:, :, None]
    gram = np.einsum("njk,njl->nkl", weighted, columns)
    moment = np.einsum("njk,nj->nk", weighted, residual)
    return Running(*(_summed(x) for x in (gram, moment, np.sum(weight * residual**2, axis=1))))


def _summed(x: np.ndarray) -> np.ndarray:
    return np.concatenate([np.zeros((1, *x.shape[1:])), np.cumsum(x, axis=0)])


def windows(n: int, shortest: int, longest: int, growth: float = 1.35, steps: int = 6) -> tuple[np.ndarray, np.ndarray]:
    """First sample and end of intervals of all lengths between two, each starting every sixth of its length."""
    starts, stops = [], []
    length = float(shortest)
    while round(length) <= min(longest, n):
        size = round(length)
        first = np.unique(np.append(np.arange(0, n - size + 1, max(1, size // steps)), n - size))
        starts.append(first)
        stops.append(first + size)
        length *= growth
    if not starts:
        return np.zeros(0, int), np.zeros(0, int)
    return np.concatenate(starts), np.concatenate(stops)
