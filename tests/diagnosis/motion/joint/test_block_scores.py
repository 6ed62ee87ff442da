"""Gains over blocks and how far they are beyond scatter; odds that grow with the square of a lead and keep its sign."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import norm, wilcoxon

from lagnet.diagnosis.motion.joint.block_scores import (
    GREATEST_ODDS,
    advantage,
    beyond_scatter,
    block_means,
    log10_odds,
)

EVENTS, BLOCKS = 4, 40  # large gains, and blocks in which a small one is as likely as a small loss


def gains(seed: int, events: int, lost: int = 0) -> np.ndarray:
    """Small gains in all blocks, large ones in a few, and as large losses in some."""
    out = np.abs(np.random.default_rng(seed).normal(scale=0.02, size=BLOCKS))
    out[:events], out[events : events + lost] = 1.0, -1.0
    return out


def test_few_large_gains_are_beyond_scatter_where_no_loss_stands_against_them():
    for_it = gains(0, EVENTS)
    assert advantage(for_it, np.zeros(BLOCKS))[1] < 3.0  # √k for k events, however large
    gain, errors = beyond_scatter(for_it, np.zeros(BLOCKS))
    assert gain == advantage(for_it, np.zeros(BLOCKS))[0]
    assert errors > 3.0
    assert beyond_scatter(np.zeros(BLOCKS), for_it)[1] < -1.0


def test_ranks_are_those_of_wilcoxon():
    for_it = np.random.default_rng(1).normal(loc=0.01, scale=0.02, size=BLOCKS) ** 3
    errors = beyond_scatter(for_it, np.zeros(BLOCKS))[1]
    expected = wilcoxon(for_it, alternative="greater", method="asymptotic").pvalue
    assert errors > advantage(for_it, np.zeros(BLOCKS))[1]
    assert norm.sf(errors) == pytest.approx(expected, rel=1e-6)


def test_scatter_about_zero_is_seldom_taken_for_a_gain():
    rng = np.random.default_rng(2)
    scattered = rng.standard_t(2.0, size=(2000, BLOCKS))
    assert np.mean([beyond_scatter(row, np.zeros(BLOCKS))[1] > 3.0 for row in scattered]) < 0.005


def test_means_are_taken_block_by_block():
    time = np.arange(0.0, 8.0, 0.02)
    windows = SimpleNamespace(first=np.array([0, 200]), last=np.array([199, 399]))
    data = SimpleNamespace(series=SimpleNamespace(time=time), windows=windows)
    means = block_means(data, np.floor(time), 1.0)  # pyright: ignore[reportArgumentType]
    assert means == pytest.approx(np.arange(8.0), abs=0.02)


def test_odds_are_those_of_a_normal_deviate():
    assert log10_odds(0.0) == 0.0
    assert log10_odds(3.0) == pytest.approx(1.954325, abs=1e-6)  # exp(9/2) = 90.017
    assert log10_odds(-3.0) == -log10_odds(3.0)
    assert log10_odds(1e3) == GREATEST_ODDS == -log10_odds(-1e3)
