"""G_b = Σ_{t∈b} [X r]ᵀ[X r]: Gram matrices of blocks of time, whose size does not grow with the recording."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.problem.problem import Problem, Segment, spread_evenly
from lagnet.diagnosis.regression.library import Library

BLOCK = 12.0  # length of a block, in periods of the bandwidth: long compared with the residual's correlation time
SHORTEST = 4.0  # the same where recordings are short
MOST_BLOCKS = 150  # longer recordings get longer blocks
MOST_SAMPLES = 120_000  # at full rate, twice those of a refit: of longer recordings, segments spread over them are used
FOLDS = 6  # of cross-validation, and the blocks that there are at least where none of them becomes too short


@dataclass(frozen=True, eq=False)
class BlockGrams:
    """G_b of each block b and joint.

    Args:
        joints: for each joint, shape (n_blocks, width + 1, width + 1); the residual is the last row and column.
        counts: shape (n_blocks, dof), number of valid samples in each.
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
        """Number of valid samples of the joint."""
        return float(self.counts[:, joint].sum())


def collect_block_grams(
    problem: Problem, library: Library, pieces: tuple[Segment, ...], known: Mapping[int, np.ndarray] | None = None
) -> BlockGrams:
    """G_b of all blocks, summed segment by segment, so that only the columns of one segment are in memory.

    Of more than `MOST_SAMPLES` samples, segments spread evenly over them are taken.

    Args:
        problem: gives the columns.
        library: the hypotheses.
        pieces: segments, fitted or held out.
        known: matrices of joints that have been collected from the same columns, by joint.
    """
    known = known or {}
    joints = [j for j in range(problem.n_dof) if j not in known]
    pieces = spread_evenly(pieces, MOST_SAMPLES)
    total = sum(p.keep.size for p in pieces)
    reduced_rate = total / max(1e-9, sum(np.ptp(p.time[p.keep]) for p in pieces if p.keep.size > 1))
    length = max(block_length(total, reduced_rate, problem.bandwidth), total // MOST_BLOCKS)
    blocks = [np.array_split(np.arange(p.keep.size), max(1, round(p.keep.size / length))) for p in pieces]
    grams = {j: np.empty((sum(map(len, blocks)), *2 * (library.width(j) + 1,))) for j in joints}
    first = 0
    for piece, rows in zip(pieces, blocks, strict=True):
        for joint, table in zip(joints, library.tables(problem, piece, joints), strict=True):
            _fill(grams[joint][first:], table * piece.counts[:, [joint]], rows)
        first += len(rows)
    counts = [p.counts[b].sum(axis=0) for p, rows in zip(pieces, blocks, strict=True) for b in rows]
    recordings = np.repeat([p.recording for p in pieces], [len(rows) for rows in blocks])
    by_joint = {**known, **grams}
    return BlockGrams(tuple(by_joint[j] for j in range(problem.n_dof)), np.array(counts, dtype=float), recordings)


def block_length(samples: int, rate: float, bandwidth: float) -> int:
    """Samples of a block of time: twelve periods of the bandwidth, or fewer where some folds would be empty.

    Args:
        samples: of all segments together.
        rate: of these samples [Hz].
        bandwidth: of the low-pass on torques [Hz].
    """
    period = rate / bandwidth
    return max(int(min(BLOCK * period, max(SHORTEST * period, samples / FOLDS))), 8)


def _fill(grams: np.ndarray, table: np.ndarray, blocks: Sequence[np.ndarray]) -> None:
    for gram, rows in zip(grams, blocks, strict=False):  # of this segment; those of later ones follow
        part = table[rows[0] : rows[-1] + 1]
        np.matmul(part.T, part, out=gram)
