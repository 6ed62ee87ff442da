"""Intervals of a mean hold it where residuals are alike over many blocks, and stay as they were where they are not."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import t as student

from lagnet.diagnosis.estimation.intervals.long_run import long_run_excess


def half_width(blocks: np.ndarray, counts: list[int]) -> float:
    """Of a mean over all blocks, from single blocks and their runs [units of the mean]."""
    parts = (blocks - blocks.mean())[:, None] / len(blocks)
    single = student.ppf(0.975, len(blocks) - 1) ** 2 * np.sum(parts**2)
    return float(np.sqrt(single + long_run_excess(parts, counts)[0]))


def coverage(memory: float, draws: int = 400) -> float:
    """Share of intervals that hold the true mean, of block means with a given memory from one to the next."""
    rng = np.random.default_rng(5)
    held = 0
    for _ in range(draws):
        x = [rng.normal() / np.sqrt(1.0 - memory**2)]
        for _ in range(39):
            x.append(memory * x[-1] + rng.normal())
        blocks = np.array(x)
        held += abs(blocks.mean()) <= half_width(blocks, [20, 20])
    return held / draws


def test_independent_blocks_are_held_as_often_as_told_and_hardly_more() -> None:
    assert 0.93 <= coverage(0.0) <= 0.99


def test_blocks_that_are_alike_are_held_far_more_often_than_by_single_blocks() -> None:
    assert coverage(0.6) > 0.88  # single blocks: 0.68


@pytest.mark.parametrize("counts", [[3], [1, 1, 1], [2, 5]])
def test_too_few_runs_say_nothing_more(counts: list[int]) -> None:
    blocks = np.ones((sum(counts), 2))
    assert np.all(long_run_excess(blocks, counts) >= 0.0)
    if sum(counts) < 4:
        assert np.all(long_run_excess(blocks, counts) == 0.0)


def test_runs_do_not_reach_over_the_end_of_a_segment() -> None:
    alternating = np.tile([[1.0], [-1.0]], (8, 1))
    apart = long_run_excess(alternating, [1] * 16)
    assert apart[0] == 0.0
    alike = np.ones((16, 1))
    assert long_run_excess(alike, [16])[0] > 0.0
    assert long_run_excess(alike, [1] * 16)[0] == 0.0
