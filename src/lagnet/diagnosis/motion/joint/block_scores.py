"""½ log mean e² over blocks of held-out motion: the score of a law, and the gain of one law over another."""

from __future__ import annotations

from math import log

import numpy as np
from scipy.stats import rankdata

from lagnet.diagnosis.motion.joint.fitting import JointData

LONGEST = 2.0  # [s] of a block
BLOCKS = 40  # that there should be at least
SHORTEST = 0.25  # [s] of a block
GREATEST_ODDS = 99.0  # powers of ten that are told


def block_length(*parts: JointData) -> float:
    """Length of the blocks of some data [s]: `BLOCKS` of them, but of `SHORTEST` to `LONGEST` seconds."""
    total = sum(float(np.sum(d.series.time[d.windows.last] - d.series.time[d.windows.first])) for d in parts)
    return float(np.clip(total / BLOCKS, SHORTEST, LONGEST))


def block_scores(data: JointData, law: np.ndarray, floor: float, length: float | None = None) -> np.ndarray:
    """½ log(mean e² + floor²) of the error e in each block, shape (n_blocks,); smaller is better.

    It is the negative log-likelihood of errors whose variance differs from block to block, up to a constant: a contact
    that nothing explains has no more weight than any other block.

    Args:
        data: windows that were not fitted.
        law: shape (len(LAW),).
        floor: resolution of the error [rad].
        length: of a block [s]; None: that of these data alone.
    """
    return 0.5 * np.log(block_means(data, data.errors(law) ** 2, length) + floor**2)


def block_means(data: JointData, values: np.ndarray, length: float | None = None) -> np.ndarray:
    """Means of values of every sample, shape (n,), over the blocks of the data's windows, shape (n_blocks,)."""
    out, time = [], data.series.time
    length = length or block_length(data)
    for first, last in zip(data.windows.first, data.windows.last, strict=True):
        count = max(1, round(float(time[last] - time[first]) / length))
        out += [part.mean() for part in np.array_split(values[first : last + 1], count)]
    return np.array(out)


def advantage(without: np.ndarray, with_it: np.ndarray) -> tuple[float, float]:
    """Mean gain of the block scores (0.03: errors 3 % smaller), and that gain over its standard error, over blocks."""
    gains = without - with_it
    error = float(np.std(gains) / np.sqrt(len(gains))) + 1e-12
    return float(gains.mean()), float(gains.mean() / error)


def beyond_scatter(without: np.ndarray, with_it: np.ndarray) -> tuple[float, float]:
    """Mean gain of the block scores, and its size in standard errors: by `advantage` or by ranks, whichever is larger.

    What shows in few blocks, as a break-away does, scatters for being large: k equal gains among blocks of none are
    √k standard errors, however large they are. Ranks ask whether as large losses stand against them:
    z = Σ sign(g) rank |g| / √Σ rank². Source: Wilcoxon 1945 (signed ranks).
    """
    gain, errors = advantage(without, with_it)
    ranks = rankdata(np.abs(without - with_it))
    return gain, max(errors, float(np.sign(without - with_it) @ ranks / np.sqrt(ranks @ ranks)))


def log10_odds(errors: float) -> float:
    """½ x |x| / ln 10, within ±`GREATEST_ODDS`: the odds of two laws whose scores differ by x standard errors."""
    return max(-GREATEST_ODDS, min(GREATEST_ODDS, 0.5 * errors * abs(errors) / log(10.0)))
