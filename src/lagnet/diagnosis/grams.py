"""Evidence in a size that does not grow with the recording: normal equations of blocks of time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.library import Library
from lagnet.diagnosis.problem import Piece, Problem, spread_evenly

BLOCK = 12.0  # length of a block, in periods of the bandwidth: long against the memory of the residual
MOST_BLOCKS = 150  # longer recordings get longer blocks
MOST_SAMPLES = 250_000  # at full rate: of longer recordings, pieces spread over them are evidence enough
FOLDS = 6  # for judging a fit on blocks that it has not seen


@dataclass(frozen=True, eq=False)
class Grams:
    """Sums of squares and products per block and joint.

    Args:
        joints: for each joint, shape (n_blocks, width + 1, width + 1); the residual is the last row and column.
        counts: shape (n_blocks, dof), samples in each.
        recording: shape (n_blocks,), which recording a block is of.
    """

    joints: tuple[np.ndarray, ...]
    counts: np.ndarray
    recording: np.ndarray

    def total(self, joint: int) -> np.ndarray:
        """Sum over blocks, shape (width + 1, width + 1)."""
        return self.joints[joint].sum(axis=0)

    def folds(self, joint: int) -> np.ndarray:
        """Sums over interleaved groups of blocks, shape (FOLDS, width + 1, width + 1)."""
        return np.stack([self.joints[joint][f::FOLDS].sum(axis=0) for f in range(FOLDS)])

    def samples(self, joint: int) -> float:
        """Samples of the joint that count."""
        return float(self.counts[:, joint].sum())


def collect_grams(problem: Problem, library: Library, pieces: tuple[Piece, ...]) -> Grams:
    """Goes through the pieces one by one, so that memory holds the columns of one piece only.

    Of more than `MOST_SAMPLES` samples, pieces spread evenly over them are taken: names rest on far fewer.
    """
    pieces = spread_evenly(pieces, MOST_SAMPLES)
    total = sum(p.keep.size for p in pieces)
    reduced_rate = total / max(1e-9, sum(np.ptp(p.time[p.keep]) for p in pieces if p.keep.size > 1))
    length = max(int(BLOCK * reduced_rate / problem.bandwidth), total // MOST_BLOCKS, 8)
    grams: list[list[np.ndarray]] = [[] for _ in range(problem.n_dof)]
    counts, recordings = [], []
    for piece in pieces:
        blocks = np.array_split(np.arange(piece.keep.size), max(1, round(piece.keep.size / length)))
        for joint, table in enumerate(library.tables(problem, piece)):
            counted = table * piece.counts[:, [joint]]
            grams[joint].extend(counted[b].T @ counted[b] for b in blocks)
        counts.extend(piece.counts[b].sum(axis=0) for b in blocks)
        recordings.extend([piece.recording] * len(blocks))
    return Grams(tuple(np.stack(g) for g in grams), np.array(counts, dtype=float), np.array(recordings))
